#include "viewer/scene/view_pose.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace linescope {
namespace {

Eigen::Vector3d direction(double azimuth, double elevation) {
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

/// Upwards at roll 0: the direction's derivative by elevation, which stays good when looking straight down.
Eigen::Vector3d upright(double azimuth, double elevation) {
  return {-std::sin(elevation) * std::cos(azimuth), -std::sin(elevation) * std::sin(azimuth),
          std::cos(elevation)};
}

double azimuth_of(const Eigen::Vector3d& out, const Eigen::Vector3d& up) {
  // Straight above or below, the up direction is all that tells the azimuth.
  if (std::hypot(out.x(), out.y()) > 1e-6) return std::atan2(out.y(), out.x());
  const double sign = out.z() > 0 ? -1 : 1;
  return std::atan2(sign * up.y(), sign * up.x());
}

}  // namespace

void apply(const ViewPose& pose, vtkCamera& camera) {
  const Eigen::Vector3d out = direction(pose.azimuth, pose.elevation);
  const Eigen::Vector3d up = Eigen::AngleAxisd(-pose.roll, out) * upright(pose.azimuth, pose.elevation);
  const Eigen::Vector3d position = pose.target + pose.distance * out;
  camera.SetFocalPoint(pose.target.data());
  camera.SetPosition(position.data());
  camera.SetViewUp(up.data());
  camera.SetParallelScale(pose.distance * std::tan(camera.GetViewAngle() * std::numbers::pi / 360.0));
}

ViewPose view_pose_of(vtkCamera& camera) {
  Eigen::Vector3d position, target, up;
  camera.GetPosition(position.data());
  camera.GetFocalPoint(target.data());
  camera.GetViewUp(up.data());
  return looking_from(position - target, up, target, (position - target).norm());
}

ViewPose looking_from(const Eigen::Vector3d& outward, const Eigen::Vector3d& up,
                      const Eigen::Vector3d& target, double distance) {
  const Eigen::Vector3d out = outward.normalized();
  const Eigen::Vector3d flat_up = (up - up.dot(out) * out).normalized();
  ViewPose pose;
  pose.target = target;
  pose.distance = distance;
  pose.azimuth = azimuth_of(out, flat_up);
  pose.elevation = std::asin(std::clamp(out.z(), -1.0, 1.0));
  const Eigen::Vector3d zero = upright(pose.azimuth, pose.elevation);
  pose.roll = -std::atan2(out.dot(zero.cross(flat_up)), zero.dot(flat_up));
  return pose;
}

}  // namespace linescope
