#include "tools/export/tool_transforms.hpp"

namespace linescope {
namespace {

/// The smallest turn that brings z onto the axis; the tube itself says nothing about x and y.
Eigen::Isometry3d harvester_from_tip(const HarvesterCalibration& harvester) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), harvester.axis).toRotationMatrix();
  result.translation() = harvester.tip;
  return result;
}

SequenceTransform named(const char* name, const SensorPose& pose, const Eigen::Isometry3d& sensor_from_part) {
  return {name, pose.world_from_sensor.isometry() * sensor_from_part, pose.good};
}

}  // namespace

ToolTransforms::ToolTransforms(const Calibration& calibration, bool endoscope, bool object, bool harvester)
    : endoscope_from_camera_(calibration.endoscope_from_camera.isometry()),
      harvester_from_tip_(harvester_from_tip(calibration.harvester)),
      endoscope_(endoscope),
      object_(object),
      harvester_(harvester) {}

std::vector<SequenceTransform> ToolTransforms::at(const SensorPose& endoscope, const SensorPose& object,
                                                  const SensorPose& harvester) const {
  const Eigen::Isometry3d same = Eigen::Isometry3d::Identity();
  std::vector<SequenceTransform> transforms;
  if (endoscope_) transforms.push_back(named("EndoscopeToWorld", endoscope, same));
  if (endoscope_) transforms.push_back(named("CameraToWorld", endoscope, endoscope_from_camera_));
  if (object_) transforms.push_back(named("ObjectToWorld", object, same));
  if (harvester_) transforms.push_back(named("HarvesterToWorld", harvester, same));
  if (harvester_) transforms.push_back(named("HarvesterTipToWorld", harvester, harvester_from_tip_));
  return transforms;
}

}  // namespace linescope
