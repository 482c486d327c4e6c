#include "tools/calibrate/laser_points.hpp"

#include <fmt/format.h>

#include <cmath>

#include "tools/calibrate/board_pose.hpp"

namespace linescope::calibrate {
namespace {

bool on_board(const BoardOptions& board, const Eigen::Vector3d& p, double margin) {
  const double reach = margin * board.square_mm;
  return p.x() >= -reach && p.y() >= -reach && p.x() <= (board.corners_x - 1) * board.square_mm + reach &&
         p.y() <= (board.corners_y - 1) * board.square_mm + reach;
}

/// The board's plane as 1/z = plane . (x, y, 1).
Eigen::Vector3d inverse_depth_of(const Rigid<CameraCv, Board>& camera_from_board) {
  const Eigen::Vector3d normal = camera_from_board.rotate(Eigen::Vector3d::UnitZ());
  return normal / normal.dot(camera_from_board.translation());
}

std::vector<LaserPoint> points_of(const Observation& seen, const BoardOptions& board,
                                  const CameraModel& camera, const LaserPointOptions& options,
                                  const Rigid<CameraCv, Board>& camera_from_board) {
  const Eigen::Vector3d plane = inverse_depth_of(camera_from_board);
  const Rigid<Board, CameraCv> board_from_camera = camera_from_board.inverse();
  const Eigen::Vector2d along =
      options.axis == ProfileAxis::column ? Eigen::Vector2d::UnitY().eval() : Eigen::Vector2d::UnitX().eval();
  std::vector<LaserPoint> points;
  for (const LineSample& sample : seen.line) {
    const Eigen::Vector2d pixel(sample.u, sample.v);
    const Eigen::Vector2d ray = camera.normalised_from_pixel(pixel);
    const Eigen::Vector2d next = camera.normalised_from_pixel(pixel + along);
    LaserPoint p{ray.x(), ray.y(), plane.dot(ray.homogeneous()), next - ray, 0};
    p.inverse_step = plane.head<2>().dot(p.step);
    if (!(p.inverse_depth > 0) || !p.step.allFinite()) continue;
    if (on_board(board, board_from_camera * p.position(), options.margin_squares)) points.push_back(p);
  }
  return points;
}

}  // namespace

std::vector<LaserPicture> laser_points(const Session& session, const BoardOptions& board,
                                       const CameraModel& camera, const LaserPointOptions& options,
                                       std::vector<LeftOut>& left_out) {
  std::vector<LaserPicture> pictures;
  for (const Observation& seen : session.observations) {
    if (seen.board.empty() || seen.line.empty()) {
      left_out.push_back({seen.name, seen.board.empty() ? "no board found" : "no laser line found"});
      continue;
    }
    const auto pose = board_pose(board, camera, seen.board);
    if (!pose || pose->rms_px > options.max_board_px) {
      left_out.push_back({seen.name, pose ? fmt::format("the board fits to {:.2f} px only", pose->rms_px)
                                          : pose.error().message});
      continue;
    }
    LaserPicture picture{seen.name, pose->camera_from_board,
                         points_of(seen, board, camera, options, pose->camera_from_board)};
    if (static_cast<int>(picture.points.size()) < options.min_points)
      left_out.push_back(
          {seen.name, fmt::format("only {} points of the line lie on the board", picture.points.size())});
    else
      pictures.push_back(std::move(picture));
  }
  return pictures;
}

}  // namespace linescope::calibrate
