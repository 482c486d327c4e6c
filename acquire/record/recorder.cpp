#include "acquire/record/recorder.hpp"

#include <fmt/format.h>

#include <fstream>
#include <system_error>
#include <utility>

namespace linescope {
namespace {

namespace fs = std::filesystem;

/// Events are rare; more than these are a fault of the caller and counted.
constexpr std::size_t kLargestEventQueue = 10'000;

Result<void> make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    return fail(ErrorCode::permission,
                fmt::format("recording folder {} cannot be created: {}", folder.string(), error.message()));
  }
  if (fs::is_empty(folder, error)) return {};
  return fail(ErrorCode::busy,
              fmt::format("folder {} is not empty; name a new one for the recording", folder.string()));
}

Result<void> write_text(const fs::path& file, const std::string& text) {
  std::ofstream stream(file);
  stream << text;
  stream.flush();
  if (stream) return {};
  return fail(ErrorCode::full, fmt::format("{} cannot be written; is the disk full?", file.string()));
}

/// Everything that is known before the first picture.
Result<void> write_texts(const fs::path& folder, const RecordingInfo& info) {
  return write_recording_info(folder, info, nullptr)
      .and_then([&] { return write_text(folder / kConfigurationFile, info.configuration); })
      .and_then([&] { return save_calibration(info.calibration, folder / kCalibrationFile); });
}

}  // namespace

Result<void> validate(const RecorderOptions& options) {
  if (options.folder.empty()) return fail(ErrorCode::usage, "no folder is named for the recording");
  if (options.picture_queue < 2 || options.picture_queue > 10'000) {
    return fail(ErrorCode::invalid,
                fmt::format("a queue of {} pictures is not between 2 and 10000", options.picture_queue));
  }
  if (options.sample_queue < 16 || options.sample_queue > 10'000'000) {
    return fail(ErrorCode::invalid,
                fmt::format("a queue of {} samples is not between 16 and 10000000", options.sample_queue));
  }
  if (options.sync_every <= 0) return fail(ErrorCode::invalid, "the time between two syncs must be above 0");
  return {};
}

std::string_view name(RecorderState state) {
  switch (state) {
    case RecorderState::recording:
      return "recording";
    case RecorderState::slow:
      return "disk too slow";
    case RecorderState::disk_full:
      return "disk full";
    case RecorderState::failed:
      return "disk fails";
    case RecorderState::stopped:
      return "stopped";
  }
  return "unknown";
}

Result<std::unique_ptr<Recorder>> Recorder::start(const RecorderOptions& options, const RecordingInfo& info) {
  if (auto valid = validate(options); !valid) return tl::unexpected(valid.error());
  if (auto folder = make_folder(options.folder); !folder) return tl::unexpected(folder.error());
  auto pictures = create_record_file(options.folder / kPictureFile);
  if (!pictures) return tl::unexpected(pictures.error());
  auto tracker = create_record_file(options.folder / kTrackerFile);
  if (!tracker) return tl::unexpected(tracker.error());
  if ((*pictures)->free_bytes() < options.keep_free) {
    return fail(
        ErrorCode::full,
        fmt::format("{} MB are free for the recording {}, {} MB are kept free; make room",
                    (*pictures)->free_bytes() >> 20U, options.folder.string(), options.keep_free >> 20U));
  }
  return start(options, info, {std::move(*pictures), std::move(*tracker)});
}

Result<std::unique_ptr<Recorder>> Recorder::start(const RecorderOptions& options, const RecordingInfo& info,
                                                  Sinks sinks) {
  if (auto valid = validate(options); !valid) return tl::unexpected(valid.error());
  if (auto texts = write_texts(options.folder, info); !texts) return tl::unexpected(texts.error());
  std::unique_ptr<Recorder> recorder(new Recorder(options, info, std::move(sinks)));
  add_record(recorder->tracker_file_, info.calibration);
  if (auto written = recorder->tracker_file_.flush(); !written) return tl::unexpected(written.error());
  recorder->thread_ = std::thread([r = recorder.get()] { r->run(); });
  return recorder;
}

Recorder::Recorder(const RecorderOptions& options, const RecordingInfo& info, Sinks sinks)
    : options_(options),
      info_(info),
      pictures_(static_cast<std::size_t>(options.picture_queue)),
      samples_(static_cast<std::size_t>(options.sample_queue)),
      picture_file_(std::move(sinks.pictures), RecordFileKind::pictures),
      tracker_file_(std::move(sinks.tracker), RecordFileKind::tracker) {
  status_.state = RecorderState::recording;
}

Recorder::~Recorder() {
  stop();
}

void Recorder::add(const Frame& frame) {
  if (frame.bgr.empty() || frame.bgr.type() != CV_8UC3) {
    ++refused_;
    return;
  }
  Frame* slot = pictures_.claim();
  if (slot == nullptr) {
    ++pictures_lost_;
    return;
  }
  frame.bgr.copyTo(slot->bgr);
  slot->time = frame.time;
  slot->index = frame.index;
  slot->name = frame.name;
  pictures_.publish();
}

void Recorder::add(const PoseSample& sample) {
  PoseSample* slot = samples_.claim();
  if (slot == nullptr) {
    ++samples_lost_;
    return;
  }
  *slot = sample;
  samples_.publish();
}

void Recorder::add_event(Nanoseconds time, std::string text) {
  const std::lock_guard lock(mutex_);
  if (events_.size() < kLargestEventQueue) {
    events_.push_back({time, std::move(text)});
  } else {
    ++events_lost_;
  }
}

RecorderStatus Recorder::status() const {
  const std::lock_guard lock(mutex_);
  RecorderStatus status = status_;
  status.counters.pictures_lost_queue = pictures_lost_;
  status.counters.samples_lost_queue = samples_lost_;
  status.counters.events_lost_queue = events_lost_;
  status.counters.pictures_refused = refused_;
  return status;
}

void Recorder::stop() {
  if (!thread_.joinable()) return;
  stop_ = true;
  thread_.join();
  RecorderStatus final_status = status();
  const RecorderCounters& c = final_status.counters;
  const RecordingTotals totals{c.pictures, c.samples, c.events, c.lost()};
  const auto written = write_recording_info(options_.folder, info_, &totals);
  const std::lock_guard lock(mutex_);
  status_.state = RecorderState::stopped;
  if (!written) status_.reason = written.error().message;
}

}  // namespace linescope
