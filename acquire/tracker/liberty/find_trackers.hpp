// What trackers are plugged in, and why one of them cannot be used: for lists shown to people.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "acquire/tracker/liberty/liberty_options.hpp"
#include "common/result.hpp"

namespace linescope {

struct TrackerFinding {
  std::string where;  ///< "USB 1-2 (0f44:ff20)", "/dev/ttyUSB0"
  std::string what;   ///< "LIBERTY", "PATRIOT", "serial line"
  std::optional<Error>
      obstacle;  ///< why it cannot be used; nothing: it can (a serial line may have anything at its end)
};

/// Polhemus devices on USB, and serial lines a LIBERTY may be wired to. Devices are opened to see whether
/// that is allowed, and closed again at once; nothing is sent to them. Fails when USB cannot be used at all
/// on this machine.
Result<std::vector<TrackerFinding>> find_trackers();

/// Whether the LIBERTY that the options mean is there and can be opened; nothing is sent to it. Returns where
/// it was found; fails as its start would.
Result<std::string> look_for_liberty(const LibertyOptions& options);

}  // namespace linescope
