// What a LIBERTY would send: one binary record per station and cycle, as its manual lays them out. The
// product's own parser reads it back (acquire/tracker/liberty).
#pragma once

#include <cstdint>
#include <vector>

#include "acquire/tracker/liberty/output_list.hpp"
#include "common/rigid_transform.hpp"

namespace linescope::twin {

/// Error indicator of a sensor outside the mapped area.
inline constexpr std::uint8_t kOutsideMappedArea = 'u';

/// One station in one cycle.
struct LibertyRecord {
  int station = 0;  ///< 0-based
  std::uint32_t frame_count = 0;
  std::uint32_t milliseconds = 0;  ///< since the unit was switched on
  std::uint8_t error = ' ';
  Rigid<World, Sensor> world_from_sensor;  ///< sent as centimetres and quaternion, 32-bit floats
};

/// Appends header and body; the body holds the items of `list`.
void append_record(const LibertyRecord& record, const OutputList& list, std::vector<std::uint8_t>& bytes);

}  // namespace linescope::twin
