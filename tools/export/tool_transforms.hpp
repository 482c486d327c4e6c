// The transforms of a recording under their outside names.
#pragma once

#include <vector>

#include "common/calibration.hpp"
#include "common/pose_sample.hpp"
#include "tools/export/sequence_file.hpp"

namespace linescope {

/// Pose of a sensor, or why there is none.
struct SensorPose {
  bool good = false;
  Rigid<World, Sensor> world_from_sensor;
};

/// EndoscopeToWorld, ObjectToWorld, HarvesterToWorld, CameraToWorld and HarvesterTipToWorld, each only where
/// the tool has a station. World is the tracker's transmitter; Camera is OpenCV's frame (y down);
/// HarvesterTip has its origin at the tip and z along the tube towards the handle.
class ToolTransforms {
 public:
  ToolTransforms(const Calibration& calibration, bool endoscope, bool object, bool harvester);

  std::vector<SequenceTransform> at(const SensorPose& endoscope, const SensorPose& object,
                                    const SensorPose& harvester) const;

 private:
  Eigen::Isometry3d endoscope_from_camera_;
  Eigen::Isometry3d harvester_from_tip_;
  bool endoscope_, object_, harvester_;
};

}  // namespace linescope
