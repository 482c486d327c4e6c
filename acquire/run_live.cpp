#include <chrono>
#include <thread>

#include "acquire/acquisition.hpp"

namespace linescope {
namespace {

void follow_tracker(Acquisition& a) {
  PoseSample sample;
  while (!a.stop) {
    auto pulled = a.sources.tracker->next(sample);
    if (!pulled) a.intake->note(pulled.error());
    if (pulled && *pulled == Pull::item) {
      if (a.recorder) a.recorder->add(sample);
      a.intake->take(sample);
    }
    a.intake->report(monotonic_now());
    if (!pulled || *pulled == Pull::end) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

/// The poses of a picture come a few milliseconds after it; this wait is bounded by `longest_wait`.
void wait_for_poses(const Acquisition& a, Nanoseconds instant) {
  const Nanoseconds give_up = monotonic_now() + a.longest_wait;
  while (!a.poses.settled(instant) && monotonic_now() < give_up && !a.stop) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

void take_picture(Acquisition& a, const Frame& frame) {
  if (a.recorder) a.recorder->add(frame);
  a.state.frame(frame);
  a.pipeline.show(frame);
  a.laser.look(a.pipeline.line());
  if (a.intake && a.scan.scanning()) wait_for_poses(a, a.pipeline.instant(frame));
  a.pipeline.place(frame);
}

void follow_camera(Acquisition& a) {
  Frame frame;
  while (!a.stop) {
    auto pulled = a.sources.camera->next(frame);
    if (!pulled) a.state.note(pulled.error());
    if (pulled && *pulled == Pull::item) take_picture(a, frame);
    const Nanoseconds now = monotonic_now();
    a.desk.attend(now);
    a.state.update(now);
    if (!pulled || *pulled == Pull::end) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

}  // namespace

void run_live(Acquisition& acquisition) {
  std::thread tracker;
  if (acquisition.intake) tracker = std::thread([&] { follow_tracker(acquisition); });
  follow_camera(acquisition);
  if (tracker.joinable()) tracker.join();
}

}  // namespace linescope
