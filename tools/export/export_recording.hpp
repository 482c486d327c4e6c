// From a recording of linescope to what other programs read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "common/result.hpp"

namespace linescope {

/// What happened, for one line on the terminal.
struct ExportReport {
  std::uint64_t written = 0;       ///< frames, rows or files
  std::uint64_t without_pose = 0;  ///< of these, with at least one transform INVALID
  std::uint64_t damaged = 0;       ///< records of the recording that could not be read
  std::uint64_t other_size = 0;    ///< pictures left out because their size differs from the first
  std::string remark;              ///< about the recording itself, empty when all is well
};

/// One frame per picture, with the poses interpolated at the picture's middle of exposure (camera latency
/// taken off).
Result<ExportReport> export_pictures_sequence(const std::filesystem::path& recording,
                                              const std::filesystem::path& file);

/// One frame per tracker cycle, without pictures: every sample as it was measured.
Result<ExportReport> export_tracker_sequence(const std::filesystem::path& recording,
                                             const std::filesystem::path& file);

/// Tracker samples as the CSV that linescope-acquire takes as a tracker (time_s,station,x_mm,...; station
/// from 1).
Result<ExportReport> export_poses_csv(const std::filesystem::path& recording,
                                      const std::filesystem::path& file);

/// Pictures as PNG files 000000.png ..., and pictures.csv with their names, numbers and times.
Result<ExportReport> export_pictures(const std::filesystem::path& recording,
                                     const std::filesystem::path& folder);

/// Events as "time_s text" lines.
Result<ExportReport> export_events(const std::filesystem::path& recording, const std::filesystem::path& file);

}  // namespace linescope
