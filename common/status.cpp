#include "common/status.hpp"

namespace linescope {

std::string_view name(ToolState state) {
  switch (state) {
    case ToolState::ok:
      return "ok";
    case ToolState::distorted_field:
      return "distorted field";
    case ToolState::out_of_view:
      return "out of view";
    case ToolState::stale:
      return "stale";
    case ToolState::missing:
      return "missing";
    case ToolState::disconnected:
      return "disconnected";
    case ToolState::never_seen:
      return "never seen";
  }
  return "unknown";
}

}  // namespace linescope
