// Handing values between threads without making the display wait: the lock is held for a pointer's length
// only.
#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace linescope {

/// The newest value; older ones nobody looked at are dropped. Any threads.
template <class T>
class Latest {
 public:
  explicit Latest(std::shared_ptr<const T> first = std::make_shared<const T>()) : value_(std::move(first)) {}

  void put(std::shared_ptr<const T> value) {
    // The old value is released after the lock: freeing a picture or a mesh may take a while.
    const std::lock_guard lock(mutex_);
    value_.swap(value);
  }
  std::shared_ptr<const T> get() const {
    const std::lock_guard lock(mutex_);
    return value_;
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const T> value_;
};

/// Everything that was put since the last take, in order. Any threads.
template <class T>
class Inbox {
 public:
  void put(T item) {
    const std::lock_guard lock(mutex_);
    items_.push_back(std::move(item));
  }
  std::vector<T> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(items_, {});
  }
  bool empty() const {
    const std::lock_guard lock(mutex_);
    return items_.empty();
  }

 private:
  mutable std::mutex mutex_;
  std::vector<T> items_;
};

}  // namespace linescope
