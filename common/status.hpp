// Status is part of every value: what a pose, a line, a normal or an angle is worth, and why.
#pragma once

#include <cstdint>
#include <string_view>

#include "common/time.hpp"

namespace linescope {

/// State of a tool (sensor). Ordered: a larger value is worth less. A chain is worth its worst link.
enum class ToolState : std::uint8_t {
  ok = 0,
  distorted_field = 1,  ///< metal near by: a pose is there, but may be off
  out_of_view = 2,      ///< out of view or out of the tracker's volume
  stale = 3,            ///< the last good pose is older than kStaleAfter
  missing = 4,          ///< the station delivers, the sensor is not there
  disconnected = 5,     ///< the device is gone
  never_seen = 6,       ///< nothing ever arrived
};

/// A pose older than this is not shown any more (DESIGN.md).
inline constexpr Nanoseconds kStaleAfter = 200 * kMillisecond;

constexpr ToolState worst(ToolState a, ToolState b) {
  return a < b ? b : a;
}

/// True where a number may be derived from a pose in this state.
constexpr bool usable(ToolState state) {
  return state == ToolState::ok;
}

/// The word shown to people and written to files, for example "out of view".
std::string_view name(ToolState state);

/// `state`, or stale when an ok pose taken at `acquired` is too old at `now`.
constexpr ToolState aged(ToolState state, Nanoseconds acquired, Nanoseconds now) {
  return now - acquired > kStaleAfter ? worst(state, ToolState::stale) : state;
}

}  // namespace linescope
