// Poses of a tool, in time order, as the fits of tip and axis take them.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "common/rigid_transform.hpp"
#include "common/time.hpp"

namespace linescope::calibrate {

struct Fixture {};  ///< what holds tip or axis still: the world, or the object's sensor

struct TimedToolPose {
  Nanoseconds time = 0;
  Rigid<Fixture, Harvester> fixture_from_tool;
};
using ToolPoses = std::vector<TimedToolPose>;

}  // namespace linescope::calibrate
