// The acquisition thread of the viewer: attaches to the segment, whenever and as often as there is one, and
// passes on what is new. It never stops the daemon from anything, and nobody in the viewer waits for it.
#pragma once

#include <functional>
#include <string>
#include <thread>

#include "viewer/command_courier.hpp"
#include "viewer/latest.hpp"
#include "viewer/live_collector.hpp"
#include "viewer/scan_memory.hpp"
#include "viewer/view_state.hpp"

namespace linescope {

struct FeedOptions {
  std::string segment = "linescope";
  HeldIn held_in = HeldIn::object;
  Nanoseconds look_every = 100 * kMillisecond;  ///< for a segment, while there is none
  Nanoseconds wake_every = 10 * kMillisecond;   ///< at the latest, while attached
};

/// First fault in one sentence.
Result<void> validate(const FeedOptions& options);

/// Called in the feed's thread; must not wait.
struct FeedSinks {
  std::function<void(std::shared_ptr<const LiveView>)> live;
  std::function<void(const LineNews&)> lines;
};

class SegmentFeed {
 public:
  /// Starts the thread. Precondition: validate(options) is good.
  SegmentFeed(FeedOptions options, FeedSinks sinks);
  /// Ends the thread, within a fraction of a second.
  ~SegmentFeed();

  /// Any thread.
  CommandCourier& courier() { return courier_; }
  /// Any thread: forget the surface here, daemon or not.
  void forget_scan() { forget_.store(true); }

 private:
  void run(const std::stop_token& stop);
  void look(Nanoseconds now);
  void follow(Nanoseconds now);
  void read_lines();
  void detach(LinkState state, const std::string& why, Nanoseconds now);
  void publish(Nanoseconds now);
  void pass_on(LineNews news);

  FeedOptions options_;
  FeedSinks sinks_;
  CommandCourier courier_;
  std::atomic<bool> forget_{false};

  // The thread's own.
  std::optional<SegmentReader> reader_;
  LiveCollector collector_;
  ScanMemory memory_;
  LineCursor cursor_;
  LineBatch batch_;
  LiveView view_;

  std::jthread thread_;  ///< last: ends before what it uses
};

}  // namespace linescope
