#include "tools/calibrate/tool_poses.hpp"

#include <fmt/format.h>

#include "tools/calibrate/verdict.hpp"

namespace linescope::calibrate {

Result<void> enough_poses(const ToolPoses& poses, int least, std::string_view advice) {
  if (poses.size() >= static_cast<std::size_t>(least)) return {};
  return tl::unexpected(
      refusal(Refusal::too_few,
              fmt::format("{} good poses of the tool, at least {} are needed", poses.size(), least), advice));
}

}  // namespace linescope::calibrate
