// The command line of linescope-acquire.
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "acquire/acquire_options.hpp"
#include "common/exit_code.hpp"

namespace linescope {

/// What the user wants.
struct CommandLine {
  enum class Task { run, check, print_config, list, stop_here } task = Task::run;
  AcquireOptions options;
  std::string printed;        ///< for stop_here: what belongs on standard output (help, version)
  std::string configuration;  ///< the effective configuration as TOML
};

/// Reads configuration file and options; options win. A failure says what, where and what to do.
tl::expected<CommandLine, Refusal> read_command_line(int argc, const char* const* argv);

}  // namespace linescope
