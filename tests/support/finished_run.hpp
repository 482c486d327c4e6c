// A program run to its end, and a file read whole: what tests of command-line tools begin with.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace linescope::testing {

struct Finished {
  int code = -1;  ///< exit code; -1: killed by a signal, or not at its end in time
  std::string out, err;
};

/// `arguments[0]` is the program. Killed when it takes longer than `patience`.
Finished run_to_end(std::vector<std::string> arguments,
                    std::chrono::milliseconds patience = std::chrono::seconds(100));

/// Every byte of a file; empty when it cannot be read.
std::string file_contents(const std::filesystem::path& file);

}  // namespace linescope::testing
