// Poses of a tool, in time order, as the fits of tip and axis take them.
#pragma once

#include <string_view>
#include <vector>

#include "common/result.hpp"
#include "common/rigid_transform.hpp"
#include "common/time.hpp"

namespace linescope::calibrate {

struct Fixture {};  ///< what holds tip or axis still: the world, or the object's sensor

struct TimedToolPose {
  Nanoseconds time = 0;
  Rigid<Fixture, Harvester> fixture_from_tool;
};
using ToolPoses = std::vector<TimedToolPose>;

/// Refused (too few) below `least`, with what to do.
Result<void> enough_poses(const ToolPoses& poses, int least, std::string_view advice);

}  // namespace linescope::calibrate
