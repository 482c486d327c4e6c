#include "viewer/navigation_worker.hpp"

namespace linescope {

std::optional<HeldHarvester> last_known_harvester(const LiveView& live) {
  const ToolView& harvester = live.tool(ToolRole::harvester);
  const ToolView& object = live.tool(ToolRole::object);
  const bool in_object = live.held_in == HeldIn::object;
  if (!live.calibration_known || harvester.acquired == 0 || (in_object && object.acquired == 0))
    return std::nullopt;
  Rigid<Held, World> held_from_world;
  if (in_object) held_from_world = renamed<Held, World>(object.world_from_sensor.inverse());
  const auto held_from_harvester = held_from_world * harvester.world_from_sensor;
  return HeldHarvester{held_from_harvester * live.harvester.tip,
                       held_from_harvester.rotate(live.harvester.axis).normalized()};
}

std::optional<HeldHarvester> held_harvester(const LiveView& live) {
  if (!usable(live.tool(ToolRole::harvester).state)) return std::nullopt;
  if (live.held_in == HeldIn::object && !usable(live.tool(ToolRole::object).state)) return std::nullopt;
  return last_known_harvester(live);
}

}  // namespace linescope
