// Writes the scan that is in the segment to a file, as any reader could: in a thread of its own, so that
// acquisition goes on.
#pragma once

#include <filesystem>
#include <future>
#include <optional>
#include <string>

#include "common/result.hpp"

namespace linescope {

/// PLY (ASCII header, binary body): x y z in world, mm; intensity; standard_deviation, mm; line. Names its
/// frame and unit in comments. The file appears under its name only when it is complete. Returns the number
/// of points.
Result<std::size_t> save_scan(const std::string& segment, const std::filesystem::path& file);

/// One saving at a time. Belongs to the line's thread.
class ScanSaver {
 public:
  explicit ScanSaver(std::string segment) : segment_(std::move(segment)) {}

  /// Begins; `busy` while the former is still being written.
  Result<void> begin(const std::filesystem::path& file);

  /// The outcome of the running save, once; nothing while there is none or it is not through.
  std::optional<Result<std::size_t>> finished();

 private:
  std::string segment_;
  std::future<Result<std::size_t>> running_;
};

}  // namespace linescope
