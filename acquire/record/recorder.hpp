// Writes everything that is needed to compute a scan again, without ever holding up the capture
// (docs/recording.md).
//
//   auto recorder = Recorder::start({.folder = "scan-07"}, info);
//   (*recorder)->add(frame);   // camera thread
//   (*recorder)->add(sample);  // tracker thread
//   (*recorder)->stop();
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "acquire/record/handover_ring.hpp"
#include "acquire/record/recorded_items.hpp"
#include "acquire/record/recording_info.hpp"

namespace linescope {

struct RecorderOptions {
  std::filesystem::path folder = {};  ///< created; must not hold a recording already
  bool compress = true;               ///< pictures as row_zstd; plain when the queue is more than half full
  int picture_queue = 60;             ///< pictures that may wait for the disk (2 s at 30 Hz)
  int sample_queue = 8192;            ///< tracker samples that may wait (4 s of 8 stations at 240 Hz)
  Nanoseconds sync_every = kSecond;   ///< down to the disk: what a power failure may cost
  std::uint64_t keep_free = 256 * 1024 * 1024;  ///< bytes: recording pauses before the disk is quite full
};
Result<void> validate(const RecorderOptions& options);

enum class RecorderState : std::uint8_t {
  recording,
  slow,       ///< something was lost within the last two seconds because the disk does not keep up
  disk_full,  ///< paused: no room; tried again every second
  failed,     ///< the disk gives errors; tried again every second
  stopped,
};
std::string_view name(RecorderState state);

struct RecorderCounters {
  std::uint64_t pictures = 0;  ///< written
  std::uint64_t samples = 0;
  std::uint64_t events = 0;
  std::uint64_t bytes = 0;
  std::uint64_t pictures_lost_queue = 0;  ///< queue full: disk too slow
  std::uint64_t samples_lost_queue = 0;
  std::uint64_t events_lost_queue = 0;
  std::uint64_t pictures_lost_disk = 0;  ///< disk full or failing
  std::uint64_t samples_lost_disk = 0;
  std::uint64_t events_lost_disk = 0;
  std::uint64_t pictures_refused = 0;  ///< not 8-bit BGR, or empty

  std::uint64_t lost() const {
    return pictures_lost_queue + samples_lost_queue + events_lost_queue + pictures_lost_disk +
           samples_lost_disk + events_lost_disk + pictures_refused;
  }
};

struct RecorderStatus {
  RecorderState state = RecorderState::stopped;
  std::string reason;  ///< one sentence when it is neither recording nor stopped
  RecorderCounters counters;
};

class Recorder {
 public:
  /// The two files a recorder writes to; tests put bad disks here.
  struct Sinks {
    std::unique_ptr<RecordSink> pictures;
    std::unique_ptr<RecordSink> tracker;
  };

  /// Creates the folder with recording.toml, configuration.toml and calibration.yaml and starts the writing
  /// thread. busy: the folder holds something already; permission, full: one sentence.
  static Result<std::unique_ptr<Recorder>> start(const RecorderOptions& options, const RecordingInfo& info);
  static Result<std::unique_ptr<Recorder>> start(const RecorderOptions& options, const RecordingInfo& info,
                                                 Sinks sinks);
  ~Recorder();

  /// Copy into the queue; when it is full the item is counted as lost. Never waits for the disk and, once
  /// every slot of the queue has held a picture of that size, allocates nothing. Pictures come from one
  /// thread, samples from one (other) thread, events from any.
  void add(const Frame& frame);
  void add(const PoseSample& sample);
  void add_event(Nanoseconds time, std::string text);

  /// Any thread.
  RecorderStatus status() const;

  /// Writes what is still queued, completes recording.toml. Called by the destructor, too; the second call
  /// does nothing.
  void stop();

 private:
  Recorder(const RecorderOptions& options, const RecordingInfo& info, Sinks sinks);
  void run();
  bool write_batch();
  std::size_t take_pictures();
  std::size_t take_samples();
  std::size_t take_events();
  void flush(RecordWriter& writer, std::uint64_t RecorderCounters::*written,
             std::uint64_t RecorderCounters::*lost, std::uint64_t items);
  void sync_when_due();
  void watch_free_space();
  void pause(RecorderState state, const std::string& reason);
  void resume();
  bool paused() const;
  void judge_speed();

  const RecorderOptions options_;
  RecordingInfo info_;
  HandoverRing<Frame> pictures_;
  HandoverRing<PoseSample> samples_;
  std::atomic<std::uint64_t> pictures_lost_{0}, samples_lost_{0}, events_lost_{0}, refused_{0};
  std::atomic<bool> stop_{false};

  // Writing thread only.
  RecordWriter picture_file_;
  RecordWriter tracker_file_;
  PictureCodec codec_;
  Nanoseconds last_sync_ = 0;
  Nanoseconds retry_at_ = 0;
  Nanoseconds last_loss_ = 0;
  std::uint64_t losses_seen_ = 0;
  bool unsynced_ = false;

  mutable std::mutex mutex_;  ///< the rest
  std::vector<RecordedEvent> events_;
  RecorderStatus status_;

  std::thread thread_;
};

}  // namespace linescope
