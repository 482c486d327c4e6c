// How every program of linescope ends, for scripts. The sentence on standard error says the rest.
#pragma once

#include "common/result.hpp"

namespace linescope {

enum class ExitCode : int {
  ok = 0,
  failed = 1,           ///< anything not listed here
  usage = 2,            ///< command line
  configuration = 3,    ///< configuration file
  calibration = 4,      ///< calibration file missing, unreadable or impossible
  camera = 5,           ///< no camera, no pictures
  tracker = 6,          ///< no tracker, no poses
  already_running = 7,  ///< another daemon holds the segment
  segment = 8,          ///< the segment cannot be created or attached
};

constexpr int exit_status(ExitCode code) {
  return static_cast<int>(code);
}

/// A failure together with the way the program ends because of it.
struct Refusal {
  ExitCode exit = ExitCode::failed;
  std::string message;
};

}  // namespace linescope
