#include "viewer/navigate/angle_difference.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace linescope {
namespace {

constexpr double kShortestShare = 0.0087;  // sin of 0.5 degrees

std::optional<double> tilt_towards(const Eigen::Vector3d& n, const Eigen::Vector3d& axis,
                                   const Eigen::Vector3d& direction) {
  const Eigen::Vector3d across = direction - direction.dot(n) * n;
  if (!(across.norm() > kShortestShare * direction.norm())) return std::nullopt;
  return std::atan2(axis.dot(across.normalized()), axis.dot(n));
}

}  // namespace

double angle_difference(const Eigen::Vector3d& normal, const Eigen::Vector3d& axis) {
  return std::atan2(normal.cross(axis).norm(), normal.dot(axis));
}

std::optional<ScreenTilts> screen_tilts(const Eigen::Vector3d& normal, const Eigen::Vector3d& axis,
                                        const Eigen::Vector3d& right, const Eigen::Vector3d& up) {
  if (!(normal.norm() > 0) || !(axis.norm() > 0)) return std::nullopt;
  const Eigen::Vector3d n = normal.normalized();
  const auto to_right = tilt_towards(n, axis, right);
  const auto to_top = tilt_towards(n, axis, up);
  if (!to_right || !to_top) return std::nullopt;
  return ScreenTilts{*to_right, *to_top};
}

TipDistance tip_distance(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, const Eigen::Vector3d& foot,
                         const Eigen::Vector3d& normal) {
  const Eigen::Vector3d above = tip - foot;
  return {above.dot(normal.normalized()), above.dot(axis.normalized())};
}

}  // namespace linescope
