// Samples on their way from a device's thread to the thread that asks for them.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <vector>

#include "common/pose_sample.hpp"

namespace linescope {

/// Bounded; when nobody takes them the oldest samples make room and are counted. Allocates at construction
/// only.
class SampleQueue {
 public:
  explicit SampleQueue(std::size_t capacity) : slots_(capacity) {}

  void push(const PoseSample& sample) {
    {
      const std::lock_guard lock(mutex_);
      if (count_ == slots_.size()) {
        first_ = (first_ + 1) % slots_.size();
        --count_;
        ++overruns_;
      }
      slots_[(first_ + count_) % slots_.size()] = sample;
      ++count_;
    }
    filled_.notify_one();
  }

  /// Waits at most that long; false when nothing came.
  bool pop(PoseSample& out, Nanoseconds at_most) {
    std::unique_lock lock(mutex_);
    if (!filled_.wait_for(lock, std::chrono::nanoseconds(at_most), [this] { return count_ > 0; }))
      return false;
    out = slots_[first_];
    first_ = (first_ + 1) % slots_.size();
    --count_;
    return true;
  }

  std::uint64_t overruns() const {
    const std::lock_guard lock(mutex_);
    return overruns_;
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable filled_;
  std::vector<PoseSample> slots_;
  std::size_t first_ = 0;
  std::size_t count_ = 0;
  std::uint64_t overruns_ = 0;
};

}  // namespace linescope
