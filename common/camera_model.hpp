// Pinhole camera with lens distortion (thesis Eqs 3.1-3.3; OpenCV's k1 k2 p1 p2 k3 model).
//
// Pixels: u right, v DOWN, the centre of the first pixel is (0, 0). Directions: OpenCV's frame (y down).
#pragma once

#include <Eigen/Core>
#include <array>

#include "common/result.hpp"

namespace linescope {

struct CameraModel {
  int width = 0;                       ///< px
  int height = 0;                      ///< px
  double fx = 0;                       ///< focal length, px (thesis: alpha)
  double fy = 0;                       ///< px (thesis: beta)
  double skew = 0;                     ///< px (thesis: eta)
  double cx = 0;                       ///< principal point, px (thesis: u_o)
  double cy = 0;                       ///< px (thesis: v_o)
  std::array<double, 5> distortion{};  ///< k1 k2 p1 p2 k3; the thesis's r1 r2 t1 t2 and 0

  /// Pixel of a point in front of the camera (OpenCV frame, any unit). Precondition: point.z() > 0.
  Eigen::Vector2d project(const Eigen::Vector3d& point) const;

  /// Pixel of the normalised, undistorted direction (x, y, 1), OpenCV frame.
  Eigen::Vector2d pixel_from_normalised(const Eigen::Vector2d& xy) const;

  /// Normalised, undistorted direction (x, y) of a pixel, OpenCV frame: undistortion of the point, not of the
  /// picture. Iterates to 1e-12; outside the region where the distortion can be inverted the result is NaN.
  Eigen::Vector2d normalised_from_pixel(const Eigen::Vector2d& uv) const;

  /// The same camera at another picture size (binning, scaling): focal lengths and principal point scale
  /// along.
  CameraModel scaled_to(int new_width, int new_height) const;
};

/// All that makes a camera model impossible, in one sentence: singular matrix, focal length in other units
/// than pixels, principal point outside the picture, NaN.
Result<void> validate(const CameraModel& camera);

}  // namespace linescope
