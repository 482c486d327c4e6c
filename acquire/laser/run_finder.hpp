// From marked pixels to runs: stretches of one profile that may hold the line.
#pragma once

#include <array>
#include <cstdint>
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

  /// `vectors`: use the longest that the processor has; without them runs are the same.
  explicit RunFinder(bool vectors = true);

  /// `want_ambient`: fill ambient() too.
  void find(const PictureView& picture, const MaskRule& rule, int merge_gap, Marker marker,
            bool want_ambient);

  /// Runs of one profile.
  struct Runs {
    std::array<Run, kMostRuns> run{};
    std::size_t count = 0;
    std::size_t size() const { return count; }
    const Run& operator[](std::size_t i) const { return run[i]; }
  };
  Runs runs(int profile) const;

  /// The only run of the profile, or none (length 0).
  Run only_run(int profile) const {
    const auto p = static_cast<std::size_t>(profile);
    return count_[p] == 1 ? runs_[p] : Run{0, -1};
  }
  int run_count(int profile) const { return count_[static_cast<std::size_t>(profile)]; }

  std::uint32_t dropped() const { return dropped_; }

  /// Mean of blue, green and red (grey pictures: three times the same) over a sparse grid of pixels that were
  /// not marked: the colour of the scene without the laser.
  const std::array<float, 3>& ambient() const { return ambient_; }

 private:
  static constexpr std::int16_t kNone = -1000;  ///< so long before the picture that any mark begins a run

  /// All rows of marks; `count` words each, and before the first a row without any.
  void take_columns(const std::uint32_t* words, int count, int height);
  void take_rows(const std::uint32_t* words, int count, int height);
  /// Marks of the 32 columns from x on changed from row y - 1 to row y.
  void turn(int y, int x, std::uint32_t before, std::uint32_t now);
  /// Both with vectors that hold 32 columns; run_finder_avx512.cpp.
  void take_columns_avx512(const std::uint32_t* words, int count, int height);
  std::size_t list_changes(const std::uint32_t* words, int count, int height);
  void close_columns(int height);
  void take_row(int y, const std::uint32_t* words, int count);
  void close(int profile, Run run);
  void sample_ambient(const PictureView& picture, int y, const std::uint32_t* words);
  void finish_ambient();
  Run& run_at(std::size_t profile, int i) {
    return runs_[static_cast<std::size_t>(i) * count_.size() + profile];
  }

  bool avx512_ = false;
  int gap_ = 0;
  std::uint32_t dropped_ = 0;
  std::array<std::uint64_t, 3> ambient_sum_{};
  std::uint64_t ambient_count_ = 0;
  std::array<float, 3> ambient_{};
  std::vector<std::uint32_t> words_;    ///< marks of all rows, and before them a row without any
  std::vector<std::uint32_t> changes_;  ///< words that differ from the row above (take_columns_avx512)
  // Columns: the run that may still grow (last: kNone before the first).
  std::vector<std::int16_t> open_first_, open_last_;
  std::vector<Run> runs_;  ///< first runs of all profiles, second runs of all profiles, ...
  std::vector<int> count_;
};

}  // namespace linescope
