// Where the daemon's log goes: standard error, the systemd journal, a file.
#pragma once

#include <cstdint>
#include <filesystem>

#include "common/exit_code.hpp"
#include "common/result.hpp"

namespace linescope {

enum class LogLevel : std::uint8_t { debug, info, warning, error };

/// How lines on standard error look.
enum class LogStyle : std::uint8_t {
  automatic,  ///< journal when systemd reads standard error (JOURNAL_STREAM), else terminal
  terminal,   ///< time, level, text
  journal,    ///< "<6>text": the level as systemd reads it (sd-daemon(3)); time and name are the journal's
};

struct LogOptions {
  LogLevel level = LogLevel::info;  ///< and everything above it
  LogStyle style = LogStyle::automatic;
  std::filesystem::path file;  ///< appended to, on top of standard error; empty: none
};

/// From here on spdlog's default logger is set up so. permission: the file cannot be written.
Result<void> open_log(const LogOptions& options);

/// The last word of a program that ends: one sentence on standard error, and in the log file.
void log_refusal(const Refusal& refusal);

/// True when systemd's journal reads our standard error.
bool journal_listens();

}  // namespace linescope
