// The two row forms of recorded poses with time (timed_pose_source.hpp).
#pragma once

#include <memory>
#include <vector>

#include "acquire/tracker/csv_reader.hpp"
#include "common/pose_sample.hpp"

namespace linescope {

/// Turns the rows of one file into samples, with the times of the file.
class TimedRows {
 public:
  virtual ~TimedRows() = default;

  /// Chooses the form by the header.
  static Result<std::unique_ptr<TimedRows>> open(const std::filesystem::path& file, double mm_per_unit);

  /// Steps to the next row and appends its samples, which may be none; false at the end of the file.
  Result<bool> next(std::vector<PoseSample>& samples);

  /// Time of the row read last.
  Nanoseconds row_time() const { return row_time_; }
  const CsvReader& reader() const { return reader_; }

 protected:
  explicit TimedRows(CsvReader reader) : reader_(std::move(reader)) {}
  virtual Result<void> decode(std::vector<PoseSample>& samples) = 0;

  CsvReader reader_;
  std::size_t time_column_ = 0;
  Nanoseconds row_time_ = 0;
};

}  // namespace linescope
