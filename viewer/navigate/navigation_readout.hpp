// May this number be shown? A value is worth what the worst link of its chain is worth (DESIGN.md).
#pragma once

#include <optional>
#include <string>

#include "common/status.hpp"
#include "common/time.hpp"
#include "viewer/navigate/normal_estimate.hpp"

namespace linescope {

/// What is known of one tool at the moment of display.
struct ToolReading {
  ToolState state = ToolState::never_seen;
  Nanoseconds acquired = 0;  ///< of its last good pose
};

/// The chain behind the angle. The endoscope placed the surface: once the surface is there, it may be put
/// away, and the surface's own age is the estimate's matter; while a scan runs, its pose is part of the
/// chain.
struct NavigationLinks {
  ToolReading endoscope;
  ToolReading object;
  ToolReading harvester;
  bool scanning = false;
  bool object_tracked = true;  ///< false: the surface is held in world coordinates, there is no sensor 2
};

enum class Link : std::uint8_t { none, endoscope, object, harvester, surface };
std::string_view name(Link link);

/// A number, or which link is to blame, why and for how long.
struct NavigationReadout {
  std::optional<NormalEstimate> estimate;  ///< present: everything in it may be shown
  Link to_blame = Link::none;
  ToolState tool_state = ToolState::ok;              ///< of the tool to blame
  NormalReason surface_reason = NormalReason::none;  ///< when the surface is to blame
  Nanoseconds age = 0;  ///< of the blamed tool's last good pose, or of the surface

  /// "--" with reason and age, for example "-- harvester stale, 0.35 s"; empty when there is a number.
  std::string blank_text() const;
};

/// Tools first: an estimate made from a bad pose is never looked at. Of several bad tools the worst is named;
/// of equally bad ones harvester, object, endoscope, in this order. `now` is the moment of display.
NavigationReadout readout(const NavigationLinks& links, const NormalEstimate& estimate, Nanoseconds now);

}  // namespace linescope
