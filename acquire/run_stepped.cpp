#include <algorithm>
#include <chrono>
#include <optional>
#include <thread>

#include "acquire/acquisition.hpp"

namespace linescope {
namespace {

constexpr Nanoseconds kLongestNap = 5 * kMillisecond;

/// One source's next item, fetched ahead so that two sources can be merged by time.
template <class Item>
struct Ahead {
  Item item;
  bool full = false;
  bool ended = false;
};

class SteppedRun {
 public:
  explicit SteppedRun(Acquisition& a) : a_(a) { sample_.ended = a.intake == nullptr; }

  void run() {
    while (!a_.stop && !over()) {
      fetch_frame();
      fetch_sample();
      step();
    }
  }

 private:
  bool over() const {
    return a_.run.exit_at_end && frame_.ended && !frame_.full && (sample_.ended || !sample_.full);
  }

  void fetch_frame() {
    while (!frame_.full && !frame_.ended) {
      auto pulled = a_.sources.camera->next(frame_.item);
      if (pulled) {
        frame_.full = *pulled == Pull::item;
        if (frame_.full) frame_.item.time += shift(frame_.item.time);
        frame_.ended = *pulled == Pull::end;
        continue;
      }
      a_.state.note(pulled.error());
      const ErrorCode code = pulled.error().code;
      frame_.ended = code != ErrorCode::unreadable && code != ErrorCode::mismatch;
    }
  }

  void fetch_sample() {
    while (!sample_.full && !sample_.ended) {
      auto pulled = a_.sources.tracker->next(sample_.item);
      if (pulled) {
        sample_.full = *pulled == Pull::item;
        if (sample_.full) sample_.item.time += shift(sample_.item.time);
        sample_.ended = *pulled == Pull::end;
        continue;
      }
      a_.intake->note(pulled.error());
      sample_.ended = pulled.error().code != ErrorCode::unreadable;
    }
  }

  /// A recording is played as if it happened now: all its times are moved by the same amount, so that viewers
  /// see fresh poses. As fast as possible, its times stay what they were.
  Nanoseconds shift(Nanoseconds time) {
    if (a_.run.replay.empty() || a_.run.pace == Pace::fast) return 0;
    if (!shift_) shift_ = monotonic_now() - time;
    return *shift_;
  }

  /// The earlier of picture and sample; a picture whose poses are still to come lets samples go first.
  void step() {
    const bool frame_ready =
        frame_.full && (sample_.ended || a_.poses.settled(a_.pipeline.instant(frame_.item)));
    if (frame_ready) {
      handle_frame();
    } else if (sample_.full) {
      handle_sample();
    } else {
      attend();
      std::this_thread::sleep_for(std::chrono::nanoseconds(kLongestNap));
    }
  }

  void handle_frame() {
    if (!wait_until(frame_.item.time)) return;
    if (a_.recorder) a_.recorder->add(frame_.item);
    a_.state.frame(frame_.item);
    a_.pipeline.show(frame_.item);
    a_.laser.look(a_.pipeline.line());
    a_.pipeline.place(frame_.item);
    frame_.full = false;
    attend();
  }

  void handle_sample() {
    if (!wait_until(sample_.item.time)) return;
    if (a_.recorder) a_.recorder->add(sample_.item);
    a_.intake->take(sample_.item);
    sample_.full = false;
    attend();
  }

  void attend() {
    const Nanoseconds now = monotonic_now();
    a_.desk.attend(now);
    if (a_.intake) a_.intake->report(now);
    a_.state.update(now);
  }

  /// Real time: sleeps until `due`, attending to commands meanwhile. False when stopped.
  bool wait_until(Nanoseconds due) {
    if (a_.run.pace == Pace::fast) return !a_.stop;
    for (Nanoseconds now = monotonic_now(); now < due && !a_.stop; now = monotonic_now()) {
      attend();
      std::this_thread::sleep_for(std::chrono::nanoseconds(std::min(due - now, kLongestNap)));
    }
    return !a_.stop;
  }

  Acquisition& a_;
  Ahead<Frame> frame_;
  Ahead<PoseSample> sample_;
  std::optional<Nanoseconds> shift_;
};

}  // namespace

void run_stepped(Acquisition& acquisition) {
  SteppedRun(acquisition).run();
}

}  // namespace linescope
