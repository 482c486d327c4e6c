// The laser sheet as a plane in the thesis's camera frame (x right, y up, z forward; mm).
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>

#include "common/result.hpp"

namespace linescope {

/// normal . p = offset, |normal| = 1, offset in mm.
struct LaserPlane {
  Eigen::Vector3d normal{0, 1, 0};
  double offset = 0;

  /// Depth z (mm) at which the ray through (x, y, 1) meets the plane; nothing when it runs along the plane or
  /// meets it behind the camera.
  std::optional<double> depth_along(double x, double y) const {
    const double slope = normal.x() * x + normal.y() * y + normal.z();
    if (std::abs(slope) < 1e-12) return std::nullopt;
    const double z = offset / slope;
    if (!(z > 0)) return std::nullopt;
    return z;
  }
};

/// The special case of the thesis (Eq 4.3): y + z tan(alpha) = b. Baseline in mm, angle in radians.
LaserPlane laser_plane_from_baseline(double baseline_mm, double alpha_rad);

/// Baseline b and deviation alpha of Eq 4.3 as this plane shows them on the camera's y-z plane, or on its x-z
/// plane for a laser that stands beside the camera (b is negative to the left); `tilt` is the rest that
/// Eq 4.3 cannot express (rotation about the optical axis, radians).
struct BaselineForm {
  double baseline_mm = 0;
  double alpha_rad = 0;
  double tilt_rad = 0;
};
BaselineForm baseline_form(const LaserPlane& plane);

/// From OpenCV's frame and the form n.p + d = 0 (any scale): what calibration files hold.
Result<LaserPlane> laser_plane_from_opencv(const Eigen::Vector4d& n_and_d);
Eigen::Vector4d opencv_from_laser_plane(const LaserPlane& plane);

}  // namespace linescope
