// One run of the program, behind its command line.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/calibrate/step.hpp"

namespace linescope::calibrate {

/// For scripts. The first are those of all programs (common/exit_code.hpp).
enum Exit : int {
  kOk = 0,
  kFailed = 1,
  kUsage = 2,
  kConfiguration = 3,
  kCalibration = 4,
  kInput = 5,
  kRefused = 9
};

struct Command {
  std::string step;                   ///< name of a step, "show" or "import"
  std::filesystem::path file;         ///< show: the calibration; import: what is read
  std::filesystem::path calibration;  ///< is read and written
  std::filesystem::path from;         ///< pictures, recording, poses; empty: the segment
  std::string segment = "linescope";
  std::filesystem::path config;
  std::vector<std::string> assignments;  ///< KEY=VALUE
  std::filesystem::path plots;           ///< folder for PNGs; empty: none
  double seconds = 60;                   ///< live: at most so long
  bool dry_run = false;                  ///< shows everything, stores nothing
  bool print_config = false;
  bool print_keys = false;
};

/// Prints to standard output, complains on standard error.
Exit run(const Command& command);

}  // namespace linescope::calibrate
