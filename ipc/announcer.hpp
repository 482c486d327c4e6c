// Telling the readers that something is new, with a system call only when somebody sleeps.
#pragma once

#include <cstdint>

#include "ipc/futex.hpp"
#include "ipc/segment_types.hpp"

namespace linescope::shared {

/// Any thread. `news` counts everything published; `sleepers` holds a bit per topic that somebody sleeps for,
/// set by readers before they sleep and cleared here. A reader that dies asleep costs one wake-up, once.
class Announcer {
 public:
  Announcer(std::uint32_t& news, std::uint32_t& sleepers) : news_(&news), sleepers_(&sleepers) {}

  /// Wakes the sleepers ahead of a publication that takes microseconds, so that both run at the same time:
  /// waking up takes longer. Leaves `sleepers` as it is: who falls asleep in between is woken by announce.
  void ring_ahead(Topic topic) const noexcept {
    const auto bit = static_cast<std::uint32_t>(topic);
    if ((__atomic_load_n(sleepers_, __ATOMIC_RELAXED) & bit) != 0) futex_wake(*news_, bit);
  }

  void announce(Topic topic) const noexcept {
    const auto bit = static_cast<std::uint32_t>(topic);
    // Both sequentially consistent, like the reader's pair (set the bit, then sleep only if news is
    // unchanged): one of the two sides sees the other.
    __atomic_fetch_add(news_, 1U, __ATOMIC_SEQ_CST);
    if ((__atomic_load_n(sleepers_, __ATOMIC_SEQ_CST) & bit) == 0) return;
    __atomic_fetch_and(sleepers_, ~bit, __ATOMIC_SEQ_CST);
    futex_wake(*news_, bit);
  }

  void wake_all() const noexcept {
    __atomic_fetch_add(news_, 1U, __ATOMIC_SEQ_CST);
    futex_wake(*news_, kAllBits);
  }

 private:
  std::uint32_t* news_;
  std::uint32_t* sleepers_;
};

}  // namespace linescope::shared
