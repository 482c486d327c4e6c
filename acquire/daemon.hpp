// The life of linescope-acquire: sources, segment, run, orderly end.
#pragma once

#include <atomic>

#include "acquire/command_line.hpp"
#include "common/exit_code.hpp"

namespace linescope {

/// Runs until `stop` becomes true (signal, command shut down, end of a recording). Whatever happens, the
/// segment is gone afterwards.
tl::expected<void, Refusal> run_daemon(const CommandLine& command, std::atomic<bool>& stop);

/// --check: everything that can be known without starting. Says what it found; fails like run_daemon would.
tl::expected<std::string, Refusal> check_setup(const AcquireOptions& options);

}  // namespace linescope
