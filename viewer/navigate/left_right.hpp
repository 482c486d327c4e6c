// Two copies of one structure: readers use one while the writer changes the other, then they swap.
//
// Readers are wait-free: two atomic additions around the reading, whatever the writer does or wherever it is
// stopped. The single writer applies every change twice and waits, between the two, for readers that still
// hold the old copy. (Ramalhete and Correia, "Left-Right: a concurrency control technique with wait-free
// population oblivious reads".)
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <thread>

namespace linescope {

template <class T>
class LeftRight {
 public:
  template <class... Args>
  explicit LeftRight(const Args&... args) : copies_{T(args...), T(args...)} {}

  /// Any thread, any number at the same time. `reader` takes a const T& and must not keep it.
  template <class Reader>
  auto read(Reader&& reader) const {
    const Presence presence(present_[version_.load()].count);
    return reader(copies_[side_.load()]);
  }

  /// One thread only. `change` takes a T&, is called twice and must do the same both times.
  template <class Change>
  void write(Change&& change) {
    const std::size_t old_side = side_.load();
    change(copies_[1 - old_side]);
    side_.store(1 - old_side);
    wait_for_readers();
    change(copies_[old_side]);
  }

 private:
  struct alignas(64) Count {
    mutable std::atomic<int> count{0};
  };

  class Presence {
   public:
    explicit Presence(std::atomic<int>& count) : count_(count) { count_.fetch_add(1); }
    ~Presence() { count_.fetch_sub(1); }
    Presence(const Presence&) = delete;
    Presence& operator=(const Presence&) = delete;

   private:
    std::atomic<int>& count_;
  };

  // New readers are sent to the other counter first, so that a steady stream of them cannot hold the writer
  // for ever.
  void wait_for_readers() {
    const std::size_t old_version = version_.load();
    wait_until_empty(1 - old_version);
    version_.store(1 - old_version);
    wait_until_empty(old_version);
  }

  void wait_until_empty(std::size_t version) const {
    while (present_[version].count.load() != 0) std::this_thread::yield();
  }

  std::array<T, 2> copies_;
  std::atomic<std::size_t> side_{0};
  std::atomic<std::size_t> version_{0};
  std::array<Count, 2> present_;
};

}  // namespace linescope
