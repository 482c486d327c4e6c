#include "viewer/navigate/navigation_readout.hpp"

#include <fmt/format.h>

namespace linescope {
namespace {

struct Judgement {
  Link link = Link::none;
  ToolState state = ToolState::ok;
  Nanoseconds age = 0;

  void consider(Link candidate, const ToolReading& reading, Nanoseconds now) {
    const ToolState judged = aged(reading.state, reading.acquired, now);
    if (usable(judged) || (link != Link::none && judged <= state)) return;
    link = candidate;
    state = judged;
    age = reading.state == ToolState::never_seen ? 0 : now - reading.acquired;
  }
};

}  // namespace

std::string_view name(Link link) {
  switch (link) {
    case Link::none:
      return "";
    case Link::endoscope:
      return "endoscope";
    case Link::object:
      return "object";
    case Link::harvester:
      return "harvester";
    case Link::surface:
      return "surface";
  }
  return "unknown link";
}

std::string NavigationReadout::blank_text() const {
  if (estimate) return {};
  if (to_blame == Link::surface) return fmt::format("-- {}", name(surface_reason));
  if (tool_state == ToolState::never_seen) return fmt::format("-- {} {}", name(to_blame), name(tool_state));
  return fmt::format("-- {} {}, {:.2f} s", name(to_blame), name(tool_state), seconds_from(age));
}

NavigationReadout readout(const NavigationLinks& links, const NormalEstimate& estimate, Nanoseconds now) {
  Judgement tools;
  tools.consider(Link::harvester, links.harvester, now);
  if (links.object_tracked) tools.consider(Link::object, links.object, now);
  if (links.scanning) tools.consider(Link::endoscope, links.endoscope, now);
  NavigationReadout result;
  if (tools.link != Link::none) {
    result.to_blame = tools.link;
    result.tool_state = tools.state;
    result.age = tools.age;
  } else if (!estimate.good()) {
    result.to_blame = Link::surface;
    result.surface_reason = estimate.reason;
    result.age = estimate.age;
  } else {
    result.estimate = estimate;
  }
  return result;
}

}  // namespace linescope
