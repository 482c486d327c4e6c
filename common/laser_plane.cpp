#include "common/laser_plane.hpp"

#include <cmath>

#include "common/camera_convention.hpp"

namespace linescope {

LaserPlane laser_plane_from_baseline(double baseline_mm, double alpha_rad) {
  // y cos(alpha) + z sin(alpha) = b cos(alpha) is Eq 4.3 with a unit normal.
  const double c = std::cos(alpha_rad);
  return {{0, c, std::sin(alpha_rad)}, baseline_mm * c};
}

BaselineForm baseline_form(const LaserPlane& plane) {
  const bool beside = std::abs(plane.normal.x()) > std::abs(plane.normal.y());
  const double across = beside ? plane.normal.x() : plane.normal.y();
  const double along = beside ? plane.normal.y() : plane.normal.x();
  return {plane.offset / across, std::atan(plane.normal.z() / across), std::atan(along / across)};
}

Result<LaserPlane> laser_plane_from_opencv(const Eigen::Vector4d& n_and_d) {
  const double length = n_and_d.head<3>().norm();
  if (!n_and_d.allFinite() || length < 1e-9) {
    return fail(ErrorCode::invalid,
                "laser_plane has no direction: its first three numbers must be a normal vector");
  }
  LaserPlane plane;
  plane.normal = thesis_from_opencv(n_and_d.head<3>() / length);
  plane.offset = -n_and_d(3) / length;
  if (plane.normal.y() < 0) {
    plane.normal = -plane.normal;
    plane.offset = -plane.offset;
  }
  return plane;
}

Eigen::Vector4d opencv_from_laser_plane(const LaserPlane& plane) {
  const Eigen::Vector3d n = opencv_from_thesis(plane.normal);
  return {n.x(), n.y(), n.z(), -plane.offset};
}

}  // namespace linescope
