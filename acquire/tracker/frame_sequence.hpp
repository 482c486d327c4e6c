// A tracker's 32-bit frame count made 64 bits wide, and checked for sense before anything rests on it.
#pragma once

#include <cstdint>

#include "acquire/tracker/frame_clock.hpp"

namespace linescope {

/// A count is believed when it does not lie in the future of the clock fit and not far in its past. A count
/// that does is dropped; when three records in a row agree with each other, the device has restarted its
/// counter and a new epoch begins: frames go on rising behind the last one, the clock starts afresh.
class FrameSequence {
 public:
  enum class Verdict : std::uint8_t {
    believed,
    doubtful,   ///< drop the record
    new_epoch,  ///< believed, and the clock was reset
  };

  explicit FrameSequence(const FrameClockOptions& options) : clock_(options) {}

  /// `frame` receives the count as a 64-bit number that never goes back from epoch to epoch.
  Verdict accept(std::uint32_t count, Nanoseconds arrival, std::int64_t& frame);

  const FrameClock& clock() const { return clock_; }
  void reset();

 private:
  bool sensible(std::int64_t frame, Nanoseconds arrival) const;
  Verdict doubt(std::uint32_t count, Nanoseconds arrival, std::int64_t& frame);

  FrameClock clock_;
  bool started_ = false;
  std::int64_t newest_ = 0;  ///< highest frame so far
  std::uint32_t newest_count_ = 0;
  std::uint32_t doubtful_count_ = 0;
  int doubts_ = 0;
};

}  // namespace linescope
