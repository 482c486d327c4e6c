// Where the board lies before the camera.
#pragma once

#include <Eigen/Core>

#include "common/camera_model.hpp"
#include "common/rigid_transform.hpp"
#include "tools/calibrate/board.hpp"

namespace linescope::calibrate {

struct BoardPose {
  Rigid<CameraCv, Board> camera_from_board;
  double rms_px = 0;  ///< over the corners used
};

/// OpenCV's planar solver (both of its answers), refined to the least squares in the picture. Fails with
/// `invalid` when the corners do not fix a pose: fewer than four, all in one row, or beyond what the lens
/// model can undo.
Result<BoardPose> board_pose(const BoardOptions& options, const CameraModel& camera, const BoardView& view);

/// Distances between the corners seen and the corners of that pose, px; one per corner of the view.
std::vector<Eigen::Vector2d> corner_errors(const BoardOptions& options, const CameraModel& camera,
                                           const BoardView& view,
                                           const Rigid<CameraCv, Board>& camera_from_board);

double rms_of(const std::vector<Eigen::Vector2d>& errors);

/// Covariance of the pose for corner noise of one pixel: the first three numbers are a rotation vector
/// applied before the board's (camera's frame, rad), the last three its origin in the camera's frame (mm).
Eigen::Matrix<double, 6, 6> pose_covariance_per_px2(const BoardOptions& options, const CameraModel& camera,
                                                    const BoardView& view,
                                                    const Rigid<CameraCv, Board>& camera_from_board);

/// The corners whose ids pass a test, for errors on corners that were in no fit.
BoardView every_other(const BoardOptions& options, const BoardView& view, bool even);

}  // namespace linescope::calibrate
