#include "tools/calibrate/board_pose.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <opencv2/calib3d.hpp>

#include "tools/calibrate/rotation_vector.hpp"

namespace linescope::calibrate {
namespace {

struct PlanarPoints {
  std::vector<cv::Point3d> board;
  std::vector<cv::Point2d> rays;  ///< normalised, undistorted
};

PlanarPoints planar_points(const BoardOptions& options, const CameraModel& camera, const BoardView& view) {
  PlanarPoints points;
  for (std::size_t i = 0; i < view.ids.size(); ++i) {
    const Eigen::Vector3d corner = corner_in_board(options, view.ids[i]);
    const Eigen::Vector2d ray = camera.normalised_from_pixel({view.pixels[i].x, view.pixels[i].y});
    if (!ray.allFinite()) continue;
    points.board.emplace_back(corner.x(), corner.y(), 0);
    points.rays.emplace_back(ray.x(), ray.y());
  }
  return points;
}

bool in_one_row(const PlanarPoints& points) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const auto& p : points.board) mean += Eigen::Vector2d(p.x, p.y);
  mean /= static_cast<double>(points.board.size());
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const auto& p : points.board) {
    const Eigen::Vector2d d = Eigen::Vector2d(p.x, p.y) - mean;
    scatter += d * d.transpose();
  }
  return scatter.determinant() < 1e-6 * scatter.trace() * scatter.trace();
}

Rigid<CameraCv, Board> rigid_from(const cv::Mat& rotation, const cv::Mat& translation) {
  const Eigen::Vector3d r(rotation.at<double>(0), rotation.at<double>(1), rotation.at<double>(2));
  return {quaternion_from_vector(r),
          {translation.at<double>(0), translation.at<double>(1), translation.at<double>(2)}};
}

}  // namespace

Result<BoardPose> board_pose(const BoardOptions& options, const CameraModel& camera, const BoardView& view) {
  const PlanarPoints points = planar_points(options, camera, view);
  if (points.board.size() < 4 || in_one_row(points))
    return fail(ErrorCode::invalid, "too few corners, or all in one row: they fix no pose of the board");
  std::vector<cv::Mat> rotations, translations;
  const cv::Mat straight = cv::Mat::eye(3, 3, CV_64F);
  try {
    cv::solvePnPGeneric(points.board, points.rays, straight, cv::noArray(), rotations, translations, false,
                        cv::SOLVEPNP_IPPE);
  } catch (const cv::Exception&) {
    rotations.clear();
  }
  BoardPose best;
  best.rms_px = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    cv::solvePnPRefineLM(points.board, points.rays, straight, cv::noArray(), rotations[i], translations[i]);
    const auto pose = rigid_from(rotations[i], translations[i]);
    if (!pose.finite() || pose.translation().z() <= 0) continue;
    const double rms = rms_of(corner_errors(options, camera, view, pose));
    if (rms < best.rms_px) best = {pose, rms};
  }
  if (!std::isfinite(best.rms_px))
    return fail(ErrorCode::invalid, "the corners fix no pose of the board before this camera");
  return best;
}

std::vector<Eigen::Vector2d> corner_errors(const BoardOptions& options, const CameraModel& camera,
                                           const BoardView& view,
                                           const Rigid<CameraCv, Board>& camera_from_board) {
  std::vector<Eigen::Vector2d> errors(view.ids.size());
  for (std::size_t i = 0; i < view.ids.size(); ++i) {
    const Eigen::Vector3d p = camera_from_board * corner_in_board(options, view.ids[i]);
    const Eigen::Vector2d seen(view.pixels[i].x, view.pixels[i].y);
    errors[i] = p.z() > 0 ? Eigen::Vector2d(camera.project(p) - seen) : Eigen::Vector2d::Constant(1e6);
  }
  return errors;
}

double rms_of(const std::vector<Eigen::Vector2d>& errors) {
  double sum = 0;
  for (const Eigen::Vector2d& e : errors) sum += e.squaredNorm();
  return errors.empty() ? 0 : std::sqrt(sum / static_cast<double>(errors.size()));
}

Eigen::Matrix<double, 6, 6> pose_covariance_per_px2(const BoardOptions& options, const CameraModel& camera,
                                                    const BoardView& view,
                                                    const Rigid<CameraCv, Board>& camera_from_board) {
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
  const double step = 1e-6;
  for (const int id : view.ids) {
    const Eigen::Vector3d turned = camera_from_board.rotate(corner_in_board(options, id));
    const Eigen::Vector3d p = turned + camera_from_board.translation();
    Eigen::Matrix<double, 2, 3> by_point;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d d = p.z() * step * Eigen::Vector3d::Unit(k);
      by_point.col(k) = (camera.project(p + d) - camera.project(p - d)) / (2 * p.z() * step);
    }
    Eigen::Matrix<double, 2, 6> jacobian;
    jacobian.leftCols<3>() = -by_point * cross_matrix(turned);
    jacobian.rightCols<3>() = by_point;
    information += jacobian.transpose() * jacobian;
  }
  return information.inverse();
}

BoardView every_other(const BoardOptions& options, const BoardView& view, bool even) {
  BoardView half;
  for (std::size_t i = 0; i < view.ids.size(); ++i) {
    const int parity = (view.ids[i] % options.corners_x + view.ids[i] / options.corners_x) % 2;
    if ((parity == 0) != even) continue;
    half.ids.push_back(view.ids[i]);
    half.pixels.push_back(view.pixels[i]);
  }
  return half;
}

}  // namespace linescope::calibrate
