// How a result goes into the calibration file (docs/calibration.md): the value itself under the key that the
// daemon reads, and beside it, under `history`, when, from what and with what quality it was found, and what
// stood there before.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/calibration.hpp"
#include "tools/calibrate/verdict.hpp"

namespace linescope::calibrate {

/// One run of one step.
struct Entry {
  std::string step;         ///< "camera", "laser", "hand-eye", "harvester", "time"
  std::string date;         ///< UTC, ISO 8601; filled by make_entry
  std::string version;      ///< of the software; filled by make_entry
  std::string source;       ///< what it was found from, for people
  std::string inputs_hash;  ///< 16 hexadecimal digits
  std::string method;       ///< one line: solver, model
  std::string previous;     ///< the value that stood there before, as text; filled by store
  Quality quality;
};

Entry make_entry(std::string step, std::string source, std::uint64_t inputs_hash, std::string method,
                 Quality quality);

/// Reads the calibration of `file` (a fresh one with `fallback` when there is no such file), lets `change`
/// put the new value in, and writes value and entry; the file is replaced only when the new one is complete.
/// `change` gives back the previous value as text.
Result<void> store(const std::filesystem::path& file, const Calibration& fallback, Entry entry,
                   const std::function<std::string(Calibration&)>& change);

/// All entries, oldest first; empty for a file without history.
Result<std::vector<Entry>> read_entries(const std::filesystem::path& file);

}  // namespace linescope::calibrate
