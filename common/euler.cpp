#include "common/euler.hpp"

#include <cmath>
#include <numbers>

namespace linescope {

Eigen::Quaterniond quaternion_from_euler(const EulerAngles& angles) {
  using Eigen::AngleAxisd, Eigen::Vector3d;
  return AngleAxisd(angles.azimuth, Vector3d::UnitZ()) * AngleAxisd(angles.elevation, Vector3d::UnitY()) *
         AngleAxisd(angles.roll, Vector3d::UnitX());
}

EulerAngles euler_from_quaternion(const Eigen::Quaterniond& rotation) {
  const Eigen::Matrix3d r = rotation.normalized().toRotationMatrix();
  const double cosine = std::hypot(r(0, 0), r(1, 0));
  EulerAngles angles;
  angles.elevation = std::atan2(-r(2, 0), cosine);
  // Below about 1e-6 rad from the pole, azimuth and roll are numerically one angle.
  if (cosine < 1e-6) {
    angles.azimuth = std::atan2(-r(0, 1), r(1, 1));
    return angles;
  }
  angles.azimuth = wrapped(std::atan2(r(1, 0), r(0, 0)));
  angles.roll = wrapped(std::atan2(r(2, 1), r(2, 2)));
  return angles;
}

double wrapped(double radians) {
  const double turn = 2 * std::numbers::pi;
  const double r = std::remainder(radians, turn);
  return r <= -std::numbers::pi ? r + turn : r;
}

}  // namespace linescope
