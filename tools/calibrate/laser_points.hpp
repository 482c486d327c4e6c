// The laser line on the board as points in space: viewing ray meets board plane.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/camera_model.hpp"
#include "tools/calibrate/session.hpp"

namespace linescope::calibrate {

/// One point of the line; OpenCV's camera frame.
struct LaserPoint {
  double x = 0, y = 0;         ///< viewing ray (x, y, 1)
  double inverse_depth = 0;    ///< 1/z where the ray meets the board, 1/mm
  Eigen::Vector2d step{0, 0};  ///< change of the ray for one pixel along the profile
  double inverse_step = 0;     ///< change of the board's 1/z for that step, 1/mm

  Eigen::Vector3d position() const { return Eigen::Vector3d(x, y, 1) / inverse_depth; }
};

/// The points of one picture.
struct LaserPicture {
  std::string name;
  Rigid<CameraCv, Board> camera_from_board;
  std::vector<LaserPoint> points;
};

struct LaserPointOptions {
  int min_points = 20;  ///< per picture; with fewer it is left out
  double margin_squares =
      2;  ///< how far the flat surface goes on around the corners, in squares; points beyond are not used
  double max_board_px = 1;                 ///< RMS of the board's corners; a picture above is left out
  ProfileAxis axis = ProfileAxis::column;  ///< along which the line was looked for
};

/// One element per picture with board, line and enough points; every other one is named in `left_out`.
std::vector<LaserPicture> laser_points(const Session& session, const BoardOptions& board,
                                       const CameraModel& camera, const LaserPointOptions& options,
                                       std::vector<LeftOut>& left_out);

}  // namespace linescope::calibrate
