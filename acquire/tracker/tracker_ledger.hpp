// The books of a tracker source: what it answers to status(), station() and counters(), from any thread.
#pragma once

#include <array>
#include <mutex>

#include "acquire/tracker/tracker_source.hpp"

namespace linescope {

class TrackerLedger {
 public:
  struct Books {
    TrackerStatus status;
    TrackerCounters counters;
    std::array<StationStatus, kMaxStations> stations;
  };

  /// `change(books)` under the lock; keep it short.
  template <class Change>
  void edit(Change&& change) {
    const std::lock_guard lock(mutex_);
    change(books_);
  }

  /// Enters a sample that is handed out, and its state. Allocates nothing unless the state changed.
  void enter(const PoseSample& sample);
  /// The same for sources that keep states and reasons themselves.
  void count(const PoseSample& sample);

  TrackerStatus status() const;
  TrackerFigures figures() const;
  StationStatus station(int station) const;
  TrackerCounters counters() const;

 private:
  mutable std::mutex mutex_;
  Books books_;
};

}  // namespace linescope
