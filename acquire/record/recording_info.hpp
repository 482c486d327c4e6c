// What a recording says about itself: recording.toml.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "common/calibration.hpp"
#include "common/result.hpp"
#include "common/time.hpp"

namespace linescope {

inline constexpr int kRecordingFormat = 1;

inline constexpr const char* kInfoFile = "recording.toml";
inline constexpr const char* kConfigurationFile = "configuration.toml";
inline constexpr const char* kCalibrationFile = "calibration.yaml";
inline constexpr const char* kPictureFile = "pictures.lsrec";
inline constexpr const char* kTrackerFile = "tracker.lsrec";

/// What is known when the recording starts.
struct RecordingInfo {
  std::string version;        ///< of linescope
  std::string camera;         ///< CameraSource::description()
  std::string tracker;        ///< TrackerSource::description()
  std::string configuration;  ///< effective, as TOML
  Calibration calibration;
  int endoscope_station = 0;  ///< 0-based; -1: none
  int object_station = 1;
  int harvester_station = 2;
  Nanoseconds camera_period = 0;  ///< nominal; 0: unknown
};

/// What is known when it ends.
struct RecordingTotals {
  std::uint64_t pictures = 0;
  std::uint64_t samples = 0;
  std::uint64_t events = 0;
  std::uint64_t lost = 0;  ///< items of any kind that did not get into the files
};

/// Writes recording.toml; the old one is replaced only when the new one is complete. `totals` null: still
/// running.
Result<void> write_recording_info(const std::filesystem::path& folder, const RecordingInfo& info,
                                  const RecordingTotals* totals);

/// recording.toml as far as it is there. `configuration` and `calibration` are not in it.
struct ReadRecordingInfo {
  RecordingInfo info;
  bool complete = false;  ///< closed in an orderly way
  RecordingTotals totals;
};
/// not_found: no such folder or not a recording; unreadable; mismatch: a newer format.
Result<ReadRecordingInfo> read_recording_info(const std::filesystem::path& folder);

}  // namespace linescope
