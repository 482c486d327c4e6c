// One reading of one tracker sensor.
#pragma once

#include <cstdint>
#include <limits>

#include "common/rigid_transform.hpp"
#include "common/status.hpp"
#include "common/time.hpp"

namespace linescope {

inline constexpr int kMaxStations = 8;  ///< a LIBERTY has at most eight

/// Pose of a station in the transmitter's frame, at its own acquisition time.
struct PoseSample {
  Nanoseconds time = 0;           ///< acquisition, CLOCK_MONOTONIC
  std::uint32_t frame_count = 0;  ///< the tracker's own running number; a jump means lost samples
  std::uint8_t station = 0;       ///< 0 .. kMaxStations-1
  ToolState state = ToolState::never_seen;
  Rigid<World, Sensor> world_from_sensor;  ///< meaningless unless usable(state)
  float distortion =
      std::numeric_limits<float>::quiet_NaN();  ///< metal indicator, NaN when the device gives none
  Nanoseconds arrival =
      0;  ///< when its last byte reached this machine, CLOCK_MONOTONIC; 0 where nobody knows
};

}  // namespace linescope
