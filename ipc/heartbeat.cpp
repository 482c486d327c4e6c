#include "ipc/heartbeat.hpp"

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace linescope {

struct Heartbeat::Parts {
  explicit Parts(SegmentWriter& w) : writer(w), thread([this] { run(); }) {}

  void run() {
    std::unique_lock lock(mutex);
    while (!end) {
      if (!writer.heartbeat(monotonic_now())) lost = true;
      wake.wait_for(lock, std::chrono::milliseconds(20), [this] { return end; });
    }
  }

  SegmentWriter& writer;
  std::mutex mutex;  // of this process only; nothing of it lies in the segment
  std::condition_variable wake;
  bool end = false;
  std::atomic<bool> lost{false};
  std::thread thread;
};

Heartbeat::Heartbeat(SegmentWriter& writer) : parts_(std::make_unique<Parts>(writer)) {}

Heartbeat::~Heartbeat() {
  {
    const std::lock_guard lock(parts_->mutex);
    parts_->end = true;
  }
  parts_->wake.notify_one();
  parts_->thread.join();
}

bool Heartbeat::lost() const {
  return parts_->lost;
}

}  // namespace linescope
