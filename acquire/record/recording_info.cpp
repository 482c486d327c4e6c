#include "acquire/record/recording_info.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <fstream>
#include <system_error>

#include "common/config_schema.hpp"

namespace linescope {
namespace {

namespace fs = std::filesystem;

struct InfoFile {
  int format = kRecordingFormat;
  std::string started = "";  ///< UTC, for people
  RecordingInfo info;
  std::int64_t period = 0;
  bool complete = false;
  std::int64_t pictures = 0, samples = 0, events = 0, lost = 0;
};

void declare(ConfigSchema& schema, InfoFile& file) {
  schema.section("recording", "A recording of linescope (docs/recording.md).");
  schema.integer("recording.format", file.format, {.min = 1}, "Version of this folder's format.");
  schema.text("recording.version", file.info.version, "linescope that wrote it.");
  schema.text("recording.started_utc", file.started, "Date and time, for people.");
  schema.text("recording.camera", file.info.camera, "Where the pictures came from.");
  schema.text("recording.tracker", file.info.tracker, "Where the poses came from.");
  schema.integer("recording.camera_period_ns", file.period, {.unit = "ns", .min = 0}, "Nominal; 0: unknown.");
  schema.section("stations", "Which tracker station carried which tool, from 0; -1: none.");
  schema.integer("stations.endoscope", file.info.endoscope_station, {.min = -1, .max = 7},
                 "Sensor on the endoscope.");
  schema.integer("stations.object", file.info.object_station, {.min = -1, .max = 7}, "Sensor on the knee.");
  schema.integer("stations.harvester", file.info.harvester_station, {.min = -1, .max = 7},
                 "Sensor on the harvester.");
  schema.section("totals",
                 "Written when the recording was closed; not complete: the writing process was killed.");
  schema.flag("totals.complete", file.complete, "Closed in an orderly way.");
  schema.integer("totals.pictures", file.pictures, {.min = 0}, "In pictures.lsrec.");
  schema.integer("totals.samples", file.samples, {.min = 0}, "Tracker samples in tracker.lsrec.");
  schema.integer("totals.events", file.events, {.min = 0}, "Events in tracker.lsrec.");
  schema.integer("totals.lost", file.lost, {.min = 0}, "Items that the disk did not take in time.");
}

/// The beginning is remembered by the file itself: the second writing takes it over.
std::string started_utc(const fs::path& folder) {
  InfoFile old;
  ConfigSchema schema;
  declare(schema, old);
  if (schema.read_file(folder / kInfoFile).empty() && !old.started.empty()) return old.started;
  return fmt::format("{:%Y-%m-%d %H:%M:%S}", fmt::gmtime(std::time(nullptr)));
}

Result<void> replace_file(const fs::path& file, const std::string& content) {
  const fs::path fresh = file.string() + ".new";
  {
    std::ofstream stream(fresh, std::ios::trunc);
    stream << content;
    stream.flush();
    if (!stream)
      return fail(ErrorCode::full, fmt::format("{} cannot be written; is the disk full?", fresh.string()));
  }
  std::error_code error;
  fs::rename(fresh, file, error);
  if (error)
    return fail(ErrorCode::permission,
                fmt::format("{} cannot be written: {}", file.string(), error.message()));
  return {};
}

}  // namespace

Result<void> write_recording_info(const fs::path& folder, const RecordingInfo& info,
                                  const RecordingTotals* totals) {
  InfoFile file;
  file.info = info;
  file.started = started_utc(folder);
  file.period = info.camera_period;
  file.complete = totals != nullptr;
  if (totals != nullptr) {
    file.pictures = static_cast<std::int64_t>(totals->pictures);
    file.samples = static_cast<std::int64_t>(totals->samples);
    file.events = static_cast<std::int64_t>(totals->events);
    file.lost = static_cast<std::int64_t>(totals->lost);
  }
  ConfigSchema schema;
  declare(schema, file);
  return replace_file(folder / kInfoFile, schema.to_toml());
}

Result<ReadRecordingInfo> read_recording_info(const fs::path& folder) {
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) {
    return fail(ErrorCode::not_found,
                fmt::format("there is no recording {}; name the folder of a recording", folder.string()));
  }
  if (!fs::exists(folder / kInfoFile, ignored)) {
    return fail(ErrorCode::not_found,
                fmt::format("{} is not a recording: it has no {}", folder.string(), kInfoFile));
  }
  InfoFile file;
  ConfigSchema schema;
  declare(schema, file);
  const auto faults = schema.read_file(folder / kInfoFile);
  if (!faults.empty()) return fail(ErrorCode::unreadable, faults.front().message);
  if (file.format > kRecordingFormat) {
    return fail(
        ErrorCode::mismatch,
        fmt::format("recording {} has format {}, this program knows up to {}; use linescope {} or newer",
                    folder.string(), file.format, kRecordingFormat, file.info.version));
  }
  ReadRecordingInfo result{std::move(file.info), file.complete, {}};
  result.info.camera_period = file.period;
  result.totals = {static_cast<std::uint64_t>(file.pictures), static_cast<std::uint64_t>(file.samples),
                   static_cast<std::uint64_t>(file.events), static_cast<std::uint64_t>(file.lost)};
  return result;
}

}  // namespace linescope
