#include "acquire/record/recording.hpp"

#include <fmt/format.h>

#include <fstream>
#include <sstream>

namespace linescope {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  if (stream.peek() != std::ifstream::traits_type::eof()) text << stream.rdbuf();
  return text.str();
}

/// With every bit, from the tracker file's first record.
Result<Calibration> exact_calibration(const fs::path& folder) {
  auto reader = RecordReader::open(folder / kTrackerFile, RecordFileKind::tracker);
  if (!reader) return tl::unexpected(reader.error());
  Record record;
  const auto pull = reader->next(record);
  const bool there =
      pull && *pull == Pull::item && record.type == static_cast<std::uint32_t>(RecordType::calibration);
  if (there) return read_calibration(record);
  return fail(ErrorCode::unreadable, fmt::format("{} does not begin with the calibration", kTrackerFile));
}

void add_remark(Recording& recording, const std::string& text) {
  recording.remark += (recording.remark.empty() ? "" : "; ") + text;
}

}  // namespace

Result<Recording> open_recording(const fs::path& folder) {
  auto read = read_recording_info(folder);
  if (!read) return tl::unexpected(read.error());
  Recording recording{folder, std::move(read->info), read->complete, read->totals, {}};
  if (!recording.complete) add_remark(recording, "the recording was not closed: its end may be missing");
  recording.info.configuration = text_of(folder / kConfigurationFile);
  if (auto exact = exact_calibration(folder)) {
    recording.info.calibration = std::move(*exact);
    return recording;
  }
  auto calibration = load_calibration(folder / kCalibrationFile);
  if (!calibration) return tl::unexpected(calibration.error());
  recording.info.calibration = std::move(*calibration);
  add_remark(recording, fmt::format("the calibration is taken from {}: results may differ in the last digit",
                                    kCalibrationFile));
  return recording;
}

Result<std::vector<RecordedEvent>> read_events(const fs::path& folder) {
  auto reader = RecordReader::open(folder / kTrackerFile, RecordFileKind::tracker);
  if (!reader) return tl::unexpected(reader.error());
  std::vector<RecordedEvent> events;
  Record record;
  for (;;) {
    const auto pull = reader->next(record);
    if (pull && *pull == Pull::end) return events;
    if (!pull || record.type != static_cast<std::uint32_t>(RecordType::event)) continue;
    if (auto event = read_event(record)) events.push_back(std::move(*event));
  }
}

}  // namespace linescope
