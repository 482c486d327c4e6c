// A ring of pose samples of one station: one thread writes, one other thread reads, no lock, no allocation.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "common/pose_sample.hpp"

namespace linescope {

/// Samples have a running index 0, 1, 2 ...; the newest `capacity` of them can be read. A reader that was
/// overtaken by the writer is told so and never sees half a sample: the writer announces the index it is
/// about to overwrite before it touches the first word, and the reader checks that announcement after it has
/// read the last one.
class SampleRing {
 public:
  /// Room for at least `capacity` samples (2 or more).
  explicit SampleRing(int capacity);

  void push(const PoseSample& sample);

  /// One past the newest index.
  std::uint64_t end() const { return written_.load(std::memory_order_acquire); }
  /// The oldest index that can be read while `end()` was `end`.
  std::uint64_t begin(std::uint64_t end) const;

  /// False when the sample was overwritten meanwhile.
  bool read(std::uint64_t index, PoseSample& out) const;
  /// Only its time.
  bool read_time(std::uint64_t index, Nanoseconds& out) const;

 private:
  static constexpr std::size_t kWords = 11;
  using Slot = std::array<std::atomic<std::uint64_t>, kWords>;

  bool still_there(std::uint64_t index) const;

  std::vector<Slot> slots_;
  std::atomic<std::uint64_t> announced_{0};
  std::atomic<std::uint64_t> written_{0};
};

}  // namespace linescope
