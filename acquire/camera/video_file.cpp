#include "acquire/camera/video_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <system_error>
#include <utility>

namespace linescope {
namespace {

/// What a file without a usable rate is read at.
constexpr double kFallbackRate = 25;

Nanoseconds period_from_rate(double rate_hz) {
  const bool plausible = std::isfinite(rate_hz) && rate_hz > 0.01 && rate_hz < 100'000;
  return std::llround(1e9 / (plausible ? rate_hz : kFallbackRate));
}

bool opened(cv::VideoCapture& capture, const std::string& file) {
  try {
    return capture.open(file, cv::CAP_FFMPEG);
  } catch (const cv::Exception&) {
    return false;
  }
}

}  // namespace

Result<void> validate(const VideoFileOptions& options) {
  if (options.file.empty()) return fail(ErrorCode::usage, "no video file is named");
  if (options.period < 0) {
    return fail(ErrorCode::invalid,
                fmt::format("the time between two pictures cannot be negative, it is {} ms",
                            milliseconds_from(options.period)));
  }
  if (options.width < 0 || options.height < 0 || (options.width == 0) != (options.height == 0)) {
    return fail(ErrorCode::invalid,
                fmt::format("an expected picture size of {}x{} px makes no sense; give both or none",
                            options.width, options.height));
  }
  return {};
}

VideoFile::VideoFile(VideoFileOptions options) : options_(std::move(options)) {}

Result<void> VideoFile::start() {
  if (auto valid = validate(options_); !valid) return valid;
  const std::string file = options_.file.string();
  std::error_code ignored;
  if (!std::filesystem::exists(options_.file, ignored)) {
    return fail(ErrorCode::not_found, fmt::format("there is no video file {}; check the path", file));
  }
  if (!opened(capture_, file)) {
    return fail(
        ErrorCode::unreadable,
        fmt::format("{} cannot be read as a video; try to play it with ffplay, or name another file", file));
  }
  period_ = options_.period > 0 ? options_.period : period_from_rate(capture_.get(cv::CAP_PROP_FPS));
  announced_ = capture_.get(cv::CAP_PROP_FRAME_COUNT);
  stamps_usable_ = options_.period == 0;
  position_ = 0;
  status_ = {};
  status_.state = CameraState::waiting;
  return {};
}

Nanoseconds VideoFile::time_of_current() {
  if (stamps_usable_) {
    const double milliseconds = capture_.get(cv::CAP_PROP_POS_MSEC);
    const Nanoseconds time = options_.start_time + std::llround(milliseconds * 1e6);
    if (position_ == 0 || time > last_time_) return time;
    stamps_usable_ = false;
    status_.remarks.push_back(
        fmt::format("{}: the time stamps stop rising at picture {}; from there on its nominal rate counts",
                    options_.file.string(), position_));
  }
  return position_ == 0 ? options_.start_time : last_time_ + period_;
}

Result<Pull> VideoFile::next(Frame& frame) try {
  if (status_.state == CameraState::not_started)
    return fail(ErrorCode::usage, "the video file was not started");
  if (status_.state == CameraState::ended || !capture_.grab()) return finish();
  const Nanoseconds time = time_of_current();
  last_time_ = time;
  const std::uint64_t index = position_++;
  if (!capture_.retrieve(frame.bgr) || frame.bgr.empty()) {
    ++status_.counters.unreadable;
    return fail(ErrorCode::unreadable, fmt::format("picture {} of {} cannot be decoded; it is passed over",
                                                   index, options_.file.string()));
  }
  if (options_.width != 0 && (frame.bgr.cols != options_.width || frame.bgr.rows != options_.height)) {
    ++status_.counters.mismatched;
    return fail(
        ErrorCode::mismatch,
        fmt::format("picture {} of {} is {}x{} px where {}x{} px is expected; it is passed over", index,
                    options_.file.string(), frame.bgr.cols, frame.bgr.rows, options_.width, options_.height));
  }
  frame.time = time;
  frame.index = index;
  frame.name.clear();
  ++status_.counters.delivered;
  status_.state = CameraState::ok;
  return Pull::item;
} catch (const cv::Exception& error) {
  status_.state = CameraState::ended;
  status_.reason =
      fmt::format("{} cannot be read beyond picture {}: {}", options_.file.string(), position_, error.err);
  return fail(ErrorCode::gone, status_.reason);
}

Pull VideoFile::finish() {
  if (status_.state == CameraState::ended) return Pull::end;
  status_.state = CameraState::ended;
  const bool early = announced_ > 0 && static_cast<double>(position_) + 0.5 < announced_;
  status_.reason =
      early ? fmt::format("{} ends after {} of {:.0f} announced pictures; it is damaged or cut off",
                          options_.file.string(), position_, announced_)
            : fmt::format("all {} pictures were read", position_);
  return Pull::end;
}

std::string VideoFile::description() const {
  if (status_.state == CameraState::not_started) return fmt::format("video {}", options_.file.string());
  return fmt::format("video {}, {:.0f}x{:.0f} px at {:.2f} Hz", options_.file.string(),
                     capture_.get(cv::CAP_PROP_FRAME_WIDTH), capture_.get(cv::CAP_PROP_FRAME_HEIGHT),
                     1.0 / seconds_from(period_));
}

}  // namespace linescope
