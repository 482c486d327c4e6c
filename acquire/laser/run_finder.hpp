// From marked pixels to runs: stretches of one profile that may hold the line.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "acquire/laser/line_mask.hpp"

namespace linescope {

/// Marked pixels first..last of a profile, both included, holes of at most merge_gap pixels between them.
struct Run {
  std::int16_t first = 0;
  std::int16_t last = 0;
  int length() const { return last - first + 1; }
};

/// Runs of every profile of one picture, in ascending order. Reads the picture once, whatever the axis.
class RunFinder {
 public:
  /// More are dropped (the shortest first) and counted: a picture with that many has no clear line there.
  static constexpr int kMostRuns = 8;

  /// `want_ambient`: fill ambient() too.
  void find(const PictureView& picture, const MaskRule& rule, int merge_gap, Marker marker,
            bool want_ambient);

  std::span<Run> runs(int profile) {
    const auto p = static_cast<std::size_t>(profile);
    return {runs_.data() + p * kMostRuns, static_cast<std::size_t>(count_[p])};
  }

  std::uint32_t dropped() const { return dropped_; }

  /// Mean of blue, green and red (grey pictures: three times the same) over a sparse grid of pixels that were
  /// not marked: the colour of the scene without the laser.
  const std::array<float, 3>& ambient() const { return ambient_; }

 private:
  void take_columns(int y, const std::uint32_t* words, int count);
  /// Marks of the 32 columns from x on changed from row y - 1 to row y.
  void turn(int y, int x, std::uint32_t before, std::uint32_t now);
  void close_columns(int height);
  void take_row(int y, const std::uint32_t* words, int count);
  void close(int profile, Run run);
  void sample_ambient(const PictureView& picture);

  int gap_ = 0;
  std::uint32_t dropped_ = 0;
  std::array<std::uint64_t, 3> ambient_sum_{};
  std::uint64_t ambient_count_ = 0;
  std::array<float, 3> ambient_{};
  std::vector<std::uint32_t> words_;  ///< marks of all rows, and before them a row without any
  // Columns: the run that may still grow (last: kNone before the first).
  std::vector<std::int16_t> open_first_, open_last_;
  std::vector<Run> runs_;
  std::vector<int> count_;
};

}  // namespace linescope
