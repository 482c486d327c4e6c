#include "acquire/camera/device_camera.hpp"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "acquire/camera/large_pages.hpp"

namespace linescope {
namespace {

/// A driver's stamp further from now than this is on another clock.
constexpr Nanoseconds kPlausibleAge = 2 * kSecond;

Nanoseconds plausible(Nanoseconds stamp, Nanoseconds now) {
  return stamp > 0 && stamp <= now && now - stamp < kPlausibleAge ? stamp : now;
}

}  // namespace

DeviceCamera::DeviceCamera(std::unique_ptr<CaptureDevice> device, DeviceCameraTiming timing)
    : device_(std::move(device)), timing_(std::move(timing)), description_("camera") {}

DeviceCamera::~DeviceCamera() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
  device_->close();
}

Result<void> DeviceCamera::start() {
  if (thread_.joinable()) return {};
  auto device = device_->open();
  if (!device) {
    const std::lock_guard lock(mutex_);
    status_.reason = device.error().message;
    return tl::unexpected(device.error());
  }
  opened(std::move(*device));
  thread_ = std::thread([this] { run(); });
  return {};
}

Result<Pull> DeviceCamera::next(Frame& frame) {
  if (!thread_.joinable()) return fail(ErrorCode::usage, "the camera was not started");
  std::unique_lock lock(mutex_);
  const auto wait = std::chrono::nanoseconds(timing_.longest_wait);
  if (!changed_.wait_for(lock, wait, [this] { return count_ > 0; })) return Pull::nothing_yet;
  std::swap(frame, queue_[first_]);
  first_ = (first_ + 1) % kQueue;
  --count_;
  ++status_.counters.delivered;
  if (period_ > 0 && timing_.now() - frame.time > period_) ++status_.counters.late;
  return Pull::item;
}

std::string DeviceCamera::description() const {
  const std::lock_guard lock(mutex_);
  return description_;
}

CameraStatus DeviceCamera::status() const {
  const std::lock_guard lock(mutex_);
  CameraStatus status = status_;
  for (const std::string& remark : {exposure_remark_, gain_remark_}) {
    if (!remark.empty()) status.remarks.push_back(remark);
  }
  return status;
}

Nanoseconds DeviceCamera::period() const {
  const std::lock_guard lock(mutex_);
  return period_;
}

Result<void> DeviceCamera::set_exposure(double milliseconds) {
  if (!(milliseconds > 0 && milliseconds <= 10'000)) {
    return fail(ErrorCode::invalid,
                fmt::format("an exposure of {} ms is not between 0 and 10000 ms", milliseconds));
  }
  const std::lock_guard lock(mutex_);
  exposure_request_ = milliseconds;
  return {};
}

Result<void> DeviceCamera::set_gain(double gain) {
  if (!(gain >= 0)) return fail(ErrorCode::invalid, fmt::format("a gain of {} is not 0 or above", gain));
  const std::lock_guard lock(mutex_);
  gain_request_ = gain;
  return {};
}

void DeviceCamera::opened(OpenedDevice device) {
  last_picture_ = timing_.now();
  const std::lock_guard lock(mutex_);
  description_ = std::move(device.description);
  period_ = device.period;
  status_.remarks = std::move(device.remarks);
  status_.exposure_ms = device_->exposure_ms();
  status_.state = CameraState::waiting;
  status_.reason = "open, no picture yet";
}

void DeviceCamera::run() {
  while (!stopping()) {
    if (disconnected()) {
      reconnect();
    } else {
      apply_requests();
      capture();
    }
  }
}

void DeviceCamera::capture() {
  Nanoseconds stamp = 0;
  scratch_.bgr.allocator = &large_pages();  // also in a Frame that next() handed in
  const auto pull = device_->read(scratch_.bgr, stamp);
  if (pull && *pull == Pull::item) return publish(stamp);
  if (!pull && pull.error().code == ErrorCode::unreadable) {
    ++captured_;
    const std::lock_guard lock(mutex_);
    ++status_.counters.unreadable;
    return;
  }
  if (!pull) return lose(pull.error().message);
  if (*pull == Pull::end) return lose("the camera ended its stream; it is opened again");
  if (timing_.now() - last_picture_ > timing_.silence_limit) {
    lose(fmt::format("no picture for {:.1f} s; it is opened again, check the cable",
                     seconds_from(timing_.silence_limit)));
  }
}

void DeviceCamera::publish(Nanoseconds stamp) {
  const Nanoseconds now = timing_.now();
  last_picture_ = now;
  scratch_.time = plausible(stamp, now);
  scratch_.index = captured_++;
  {
    const std::lock_guard lock(mutex_);
    if (count_ == kQueue) {
      first_ = (first_ + 1) % kQueue;
      --count_;
      ++status_.counters.overrun;
    }
    std::swap(scratch_, queue_[(first_ + count_) % kQueue]);
    ++count_;
    status_.state = CameraState::ok;
    status_.reason.clear();
  }
  changed_.notify_one();
}

void DeviceCamera::lose(const std::string& reason) {
  device_->close();
  const std::lock_guard lock(mutex_);
  status_.state = CameraState::disconnected;
  status_.reason = reason;
  ++status_.counters.disconnected;
}

void DeviceCamera::reconnect() {
  if (pause(timing_.reconnect_every)) return;
  auto device = device_->open();
  if (device) return opened(std::move(*device));
  const std::lock_guard lock(mutex_);
  status_.reason = device.error().message;
}

void DeviceCamera::apply_requests() {
  std::optional<double> exposure, gain;
  {
    const std::lock_guard lock(mutex_);
    exposure = std::exchange(exposure_request_, std::nullopt);
    gain = std::exchange(gain_request_, std::nullopt);
  }
  const auto note = [this](const Result<void>& result, std::string& remark) {
    const std::lock_guard lock(mutex_);
    remark = result ? "" : result.error().message;
  };
  if (exposure) {
    note(device_->set_exposure(*exposure), exposure_remark_);
    const std::lock_guard lock(mutex_);
    status_.exposure_ms = device_->exposure_ms();
  }
  if (gain) note(device_->set_gain(*gain), gain_remark_);
}

bool DeviceCamera::pause(Nanoseconds time) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, std::chrono::nanoseconds(time), [this] { return stop_; });
}

bool DeviceCamera::disconnected() const {
  const std::lock_guard lock(mutex_);
  return status_.state == CameraState::disconnected;
}

bool DeviceCamera::stopping() const {
  const std::lock_guard lock(mutex_);
  return stop_;
}

}  // namespace linescope
