// How large a segment is and who may see it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "common/result.hpp"

namespace linescope {

struct SegmentOptions {
  std::string name = "linescope";  ///< of the shared-memory object; letters, digits, . _ - ; at most 64
  std::string group;  ///< empty: only this user (0600); else also this group (see docs/segment.md)
  std::string program = "linescope";         ///< name and version of the writer, for people; cut at 47 bytes
  std::uint32_t point_capacity = 2'400'000;  ///< points per scan: two minutes at 30 lines/s of 640
  std::uint32_t line_capacity = 8'192;       ///< lines per scan: four and a half minutes at 30 lines/s
  std::uint32_t points_per_line = 4'096;     ///< a longer line is refused
  std::uint32_t pose_history = 4'096;        ///< samples per station: 17 s at 240 Hz
  std::uint32_t picture_slots = 4;           ///< at least 3; more gives slow readers more time to copy
  std::uint32_t picture_bytes = 720 * 576 * 3;  ///< largest picture
  std::uint32_t picture_samples = 2'048;        ///< line samples kept per picture
  std::uint32_t frame_history = 512;            ///< pictures' times kept
  std::uint32_t text_bytes = 65'536;            ///< longest configuration or calibration text
};

/// First fault in one sentence.
Result<void> validate(const SegmentOptions& options);

/// Size of the main segment in bytes (the control segment adds less than 100 kB).
std::size_t segment_bytes(const SegmentOptions& options);

/// Name of the control segment that belongs to a segment.
std::string control_name(const std::string& segment_name);

}  // namespace linescope
