// Equations 4.1-4.3 and 4.9 as printed: the special cases that the general forms are tested against, and a
// reader's way in.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <optional>

#include "common/laser_plane.hpp"

namespace linescope {

/// The thesis's instrument: one focal length, no lens distortion, laser b beside the camera and turned by
/// alpha.
struct ThesisTriangulation {
  double focal_px = 0;
  double u_o = 0, v_o = 0;  ///< principal point, px
  double baseline_mm = 0;   ///< b ("l" in the sentence below Eq 4.3)
  double alpha_rad = 0;

  /// Point of pixel (u, v) in the thesis's camera frame (x right, y up, z forward), mm; nothing where the ray
  /// runs along the laser or meets it behind the camera.
  std::optional<Eigen::Vector3d> point(double u, double v) const {
    const double z = baseline_mm * focal_px / ((v_o - v) + focal_px * std::tan(alpha_rad));  // Eq 4.3
    if (!std::isfinite(z) || z <= 0) return std::nullopt;
    return Eigen::Vector3d{z * (u - u_o) / focal_px, z * (v_o - v) / focal_px, z};  // Eqs 4.1, 4.2
  }
};

/// General form: the ray through (x, y, 1), thesis's camera frame, meets any plane.
inline std::optional<Eigen::Vector3d> ray_meets_plane(const LaserPlane& plane, double x, double y) {
  const std::optional<double> z = plane.depth_along(x, y);
  if (!z) return std::nullopt;
  return Eigen::Vector3d{*z * x, *z * y, *z};
}

/// Eq 4.9: world = R_s (S_c + L_r) + T_s, mm.
///
/// R_s and T_s are what the tracker says of sensor 1, L_r is the camera's place seen from the sensor, whose
/// axes the equation takes for those of the camera. It is the special case endoscope_from_camera = (identity,
/// L_r) of world_from_endoscope * endoscope_from_camera, and needs S_c in a right-handed frame (OpenCV's, y
/// down). The frame of Eqs 4.1-4.3 is left-handed: fed with that, the equation returns the mirror image, and
/// as soon as the sensor turns or moves the stripes of a sweep do not fit each other. docs/extraction.md says
/// more.
inline Eigen::Vector3d eq_4_9(const Eigen::Matrix3d& r_s, const Eigen::Vector3d& l_r,
                              const Eigen::Vector3d& t_s, const Eigen::Vector3d& s_c) {
  return r_s * (s_c + l_r) + t_s;
}

}  // namespace linescope
