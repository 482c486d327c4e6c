// The writing side of the recorder. Everything here runs in its own thread and may wait for the disk.
#include <fmt/format.h>
#include <signal.h>

#include <chrono>

#include "acquire/record/recorder.hpp"

namespace linescope {
namespace {

constexpr auto kIdle = std::chrono::milliseconds(5);
constexpr Nanoseconds kRetryEvery = kSecond;
constexpr Nanoseconds kSlowShownFor = 2 * kSecond;

/// A file size limit is reported as a failed write, like a full disk, instead of killing the process.
void block_file_size_signal() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGXFSZ);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
}

}  // namespace

void Recorder::run() {
  block_file_size_signal();
  for (;;) {
    const bool last = stop_;
    const bool wrote = write_batch();
    sync_when_due();
    judge_speed();
    if (last && !wrote) break;
    if (!wrote) std::this_thread::sleep_for(kIdle);
  }
  picture_file_.sync();
  tracker_file_.sync();
}

/// False when there was nothing to do.
bool Recorder::write_batch() {
  if (paused() && monotonic_now() >= retry_at_) resume();
  const std::size_t events = take_events();
  const std::size_t samples = take_samples();
  const std::size_t pictures = take_pictures();
  return events + samples + pictures > 0;
}

std::size_t Recorder::take_events() {
  std::vector<RecordedEvent> events;
  {
    const std::lock_guard lock(mutex_);
    events.swap(events_);
  }
  for (const RecordedEvent& event : events) add_record(tracker_file_, event);
  flush(tracker_file_, &RecorderCounters::events, &RecorderCounters::events_lost_disk, events.size());
  return events.size();
}

std::size_t Recorder::take_samples() {
  std::size_t count = 0;
  for (PoseSample* sample = samples_.front(); sample != nullptr && count < samples_.capacity(); ++count) {
    add_record(tracker_file_, *sample);
    samples_.pop();
    sample = samples_.front();
  }
  flush(tracker_file_, &RecorderCounters::samples, &RecorderCounters::samples_lost_disk, count);
  return count;
}

/// One at a time: the tracker's samples are looked after in between.
std::size_t Recorder::take_pictures() {
  Frame* frame = pictures_.front();
  if (frame == nullptr) return 0;
  const bool behind = pictures_.size() * 2 > pictures_.capacity();
  const bool compress = options_.compress && !behind && !paused();
  add_record(picture_file_, *frame, compress ? PictureEncoding::row_zstd : PictureEncoding::plain, codec_);
  pictures_.pop();
  flush(picture_file_, &RecorderCounters::pictures, &RecorderCounters::pictures_lost_disk, 1);
  return 1;
}

void Recorder::flush(RecordWriter& writer, std::uint64_t RecorderCounters::*written,
                     std::uint64_t RecorderCounters::*lost, std::uint64_t items) {
  if (items == 0) return;
  const std::uint64_t before = writer.written_bytes();
  const auto result = paused() ? writer.discard() : writer.flush();
  {
    const std::lock_guard lock(mutex_);
    status_.counters.*(result ? written : lost) += items;
    status_.counters.bytes += writer.written_bytes() - before;
  }
  unsynced_ = true;
  if (!result && !paused()) {
    pause(result.error().code == ErrorCode::full ? RecorderState::disk_full : RecorderState::failed,
          result.error().message + "; recording pauses, the scan goes on, what was written stays readable");
  }
}

void Recorder::sync_when_due() {
  const Nanoseconds now = monotonic_now();
  if (!unsynced_ || now - last_sync_ < options_.sync_every) return;
  last_sync_ = now;
  unsynced_ = false;
  if (paused()) return;
  if (auto synced = picture_file_.sync().and_then([this] { return tracker_file_.sync(); }); !synced) {
    return pause(RecorderState::failed, synced.error().message);
  }
  watch_free_space();
}

void Recorder::watch_free_space() {
  const std::uint64_t room = picture_file_.free_bytes();
  if (room >= options_.keep_free) return;
  pause(
      RecorderState::disk_full,
      fmt::format("only {} MB are free where {} is; recording pauses until {} MB are free, the scan goes on",
                  room >> 20U, options_.folder.string(), options_.keep_free >> 20U));
}

void Recorder::pause(RecorderState state, const std::string& reason) {
  retry_at_ = monotonic_now() + kRetryEvery;
  const std::lock_guard lock(mutex_);
  status_.state = state;
  status_.reason = reason;
}

void Recorder::resume() {
  retry_at_ = monotonic_now() + kRetryEvery;
  if (picture_file_.free_bytes() < options_.keep_free) return;
  const std::lock_guard lock(mutex_);
  status_.state = RecorderState::recording;
  status_.reason.clear();
}

bool Recorder::paused() const {
  const std::lock_guard lock(mutex_);
  return status_.state == RecorderState::disk_full || status_.state == RecorderState::failed;
}

void Recorder::judge_speed() {
  const std::uint64_t losses = pictures_lost_ + samples_lost_ + events_lost_;
  const Nanoseconds now = monotonic_now();
  if (losses != losses_seen_) last_loss_ = now;
  losses_seen_ = losses;
  if (losses == 0 || paused()) return;
  const bool slow = now - last_loss_ < kSlowShownFor;
  const std::lock_guard lock(mutex_);
  status_.state = slow ? RecorderState::slow : RecorderState::recording;
  status_.reason = slow ? fmt::format("the disk of {} is too slow: {} items lost so far, the scan goes on",
                                      options_.folder.string(), losses)
                        : "";
}

}  // namespace linescope
