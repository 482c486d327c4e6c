// Hands items from one thread to one other without a lock and without allocating: the slots are used again.
#pragma once

#include <atomic>
#include <cstddef>
#include <vector>

namespace linescope {

/// One producer (claim, publish), one consumer (front, pop). Neither ever waits.
template <class T>
class HandoverRing {
 public:
  explicit HandoverRing(std::size_t capacity) : slots_(capacity) {}

  std::size_t capacity() const { return slots_.size(); }
  std::size_t size() const {
    return written_.load(std::memory_order_acquire) - taken_.load(std::memory_order_acquire);
  }

  /// Producer: the slot to fill, with what was in it long ago; null when the ring is full.
  T* claim() {
    const std::size_t written = written_.load(std::memory_order_relaxed);
    if (written - taken_.load(std::memory_order_acquire) == slots_.size()) return nullptr;
    return &slots_[written % slots_.size()];
  }
  /// Producer: the claimed slot is complete.
  void publish() { written_.store(written_.load(std::memory_order_relaxed) + 1, std::memory_order_release); }

  /// Consumer: the oldest item, null when there is none. Good until pop().
  T* front() {
    const std::size_t taken = taken_.load(std::memory_order_relaxed);
    if (taken == written_.load(std::memory_order_acquire)) return nullptr;
    return &slots_[taken % slots_.size()];
  }
  void pop() { taken_.store(taken_.load(std::memory_order_relaxed) + 1, std::memory_order_release); }

 private:
  std::vector<T> slots_;
  alignas(64) std::atomic<std::size_t> written_{0};
  alignas(64) std::atomic<std::size_t> taken_{0};
};

}  // namespace linescope
