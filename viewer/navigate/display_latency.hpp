// From a tracker sample to the number on the screen: how long it took, over the last numbers shown.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "common/time.hpp"

namespace linescope {

struct LatencySummary {
  std::uint64_t count = 0;                ///< numbers shown since the beginning
  Nanoseconds p50 = 0, p95 = 0, max = 0;  ///< over the last DisplayLatency::kKept of them
};

/// One thread: the one that draws.
class DisplayLatency {
 public:
  static constexpr std::size_t kKept = 256;

  /// A number resting on a sample taken at `sampled` is on the screen at `shown_at`. Only the first showing
  /// of a sample counts: what stays on the screen does not get later. Samples from the future are not
  /// counted.
  void shown(Nanoseconds sampled, Nanoseconds shown_at);

  LatencySummary summary() const;

 private:
  std::array<Nanoseconds, kKept> took_{};
  std::uint64_t count_ = 0;
  Nanoseconds newest_ = 0;
};

}  // namespace linescope
