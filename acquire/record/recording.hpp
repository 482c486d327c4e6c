// A recording that is there: what it is, its calibration and its events.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "acquire/record/recorded_items.hpp"
#include "acquire/record/recording_info.hpp"

namespace linescope {

struct Recording {
  std::filesystem::path folder;
  RecordingInfo
      info;  ///< `configuration` is the text of configuration.toml; `calibration` has every bit of the scan's
  bool complete =
      false;  ///< closed in an orderly way; false: the process was killed, the good part is readable
  RecordingTotals totals;  ///< meaningful when complete
  std::string remark;      ///< one sentence about what is missing or damaged, empty when nothing is
};

/// Reads recording.toml, configuration.toml and the calibration; nothing else. not_found, unreadable,
/// mismatch: one sentence. A recording whose process was killed opens, with a remark.
Result<Recording> open_recording(const std::filesystem::path& folder);

/// All events, in the order of writing.
Result<std::vector<RecordedEvent>> read_events(const std::filesystem::path& folder);

}  // namespace linescope
