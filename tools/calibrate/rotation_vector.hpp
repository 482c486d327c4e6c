// Rotations as vectors (axis times angle, rad) and back.
#pragma once

#include <Eigen/Geometry>
#include <cmath>

namespace linescope::calibrate {

inline Eigen::Quaterniond quaternion_from_vector(const Eigen::Vector3d& v) {
  const double angle = v.norm();
  if (angle < 1e-12) return Eigen::Quaterniond(1, v.x() / 2, v.y() / 2, v.z() / 2).normalized();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, v / angle));
}

/// Of length 0 to pi.
inline Eigen::Vector3d vector_from_quaternion(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0 ? -1 : 1;
  const Eigen::Vector3d v = sign * q.vec();
  const double sine = v.norm();
  if (sine < 1e-12) return 2 * v;
  return 2 * std::atan2(sine, sign * q.w()) / sine * v;
}

/// cross_matrix(a) * b == a x b
inline Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& a) {
  Eigen::Matrix3d m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

}  // namespace linescope::calibrate
