#include "acquire/state_report.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <utility>

namespace linescope {
namespace {

constexpr Nanoseconds kReportEvery = 100 * kMillisecond;

/// So long an unusable picture is the camera's reason although others are good again.
constexpr Nanoseconds kComplaintStands = 5 * kSecond;

ToolState tool_state(CameraState state) {
  switch (state) {
    case CameraState::ok:
      return ToolState::ok;
    case CameraState::disconnected:
      return ToolState::disconnected;
    case CameraState::ended:
      return ToolState::stale;
    case CameraState::not_started:
    case CameraState::waiting:
      break;
  }
  return ToolState::never_seen;
}

std::pair<DaemonState, std::string> daemon_state(const CameraStatus& camera, const TrackerSource* tracker,
                                                 const SegmentWriter& writer) {
  if (camera.state == CameraState::disconnected) return {DaemonState::camera_lost, camera.reason};
  if (tracker != nullptr && tracker->live() && !tracker->figures().delivering)
    return {DaemonState::tracker_lost, tracker->status().sentence};
  if (writer.full()) return {DaemonState::full, "the segment is full: save, then clear or begin a new scan"};
  if (camera.state == CameraState::ended) return {DaemonState::idle, "the recording is through"};
  return {writer.scanning() ? DaemonState::scanning : DaemonState::idle, {}};
}

}  // namespace

StateReport::StateReport(const CameraSource& camera, const TrackerSource* tracker, SegmentWriter& writer)
    : camera_(camera), tracker_(tracker), writer_(writer) {
  report_.name = camera.description();
  const Nanoseconds period = camera.period();
  report_.nominal_hz = period > 0 ? static_cast<float>(1e9 / static_cast<double>(period)) : 0;
}

void StateReport::note(const Error& error) {
  complaint_ = error.message;
  complaint_at_ = monotonic_now();
  spdlog::warn("camera: {}", error.message);
}

void StateReport::frame(const Frame& frame) {
  ++report_.frames;
  report_.last_good = frame.time;
  report_.width = static_cast<std::uint32_t>(frame.bgr.cols);
  report_.height = static_cast<std::uint32_t>(frame.bgr.rows);
}

void StateReport::update(Nanoseconds now) {
  // The camera's status holds text: it is looked at ten times a second, not once per picture.
  const bool due = now - last_report_ >= kReportEvery;
  if (!due && state_ != DaemonState::starting && writer_.scanning() == (state_ == DaemonState::scanning))
    return;
  const CameraStatus status = camera_.status();
  report_camera(status, now);
  report_daemon(status, now);
  count_losses(status.counters);
  last_report_ = now;
}

void StateReport::report_camera(const CameraStatus& status, Nanoseconds now) {
  log_remarks(status);
  report_.time = now;
  report_.state = tool_state(status.state);
  if (laser_ != nullptr) {
    laser_->camera_has(status.exposure_ms);
    laser_->describe(report_.reason);
    report_.exposure_ms = static_cast<float>(laser_->exposure_ms());
  }
  const bool complains = !complaint_.empty() && now - complaint_at_ < kComplaintStands;
  if (report_.state != ToolState::ok || complains)
    report_.reason = status.reason.empty() ? complaint_ : status.reason;
  writer_.set_camera_status(report_);
}

/// Settings that the camera did not take: once each time they change.
void StateReport::log_remarks(const CameraStatus& status) {
  if (status.remarks == remarks_) return;
  remarks_ = status.remarks;
  for (const std::string& remark : remarks_) spdlog::warn("camera: {}", remark);
}

void StateReport::report_daemon(const CameraStatus& status, Nanoseconds now) {
  auto [state, reason] = daemon_state(status, tracker_, writer_);
  if (recorder_ != nullptr) {
    const RecorderStatus recording = recorder_->status();
    count_recording(recording);
    if (reason.empty()) reason = recording.reason;
  }
  if (state == state_ && reason == reason_) return;
  const auto level = reason.empty() ? spdlog::level::info : spdlog::level::warn;
  spdlog::log(level, "{}{}{}", name(state), reason.empty() ? "" : ": ", reason);
  if (recorder_ != nullptr)
    recorder_->add_event(now, fmt::format("state {}{}{}", name(state), reason.empty() ? "" : ": ", reason));
  state_ = state;
  reason_ = std::move(reason);
  writer_.set_state(state_, reason_);
}

void StateReport::count_recording(const RecorderStatus& status) {
  const std::uint64_t lost = status.counters.lost();
  if (lost > recording_lost_) writer_.count(Counter::recording_dropped, lost - recording_lost_);
  recording_lost_ = lost;
}

void StateReport::count_losses(const CameraCounters& now) {
  const auto add = [&](Counter counter, std::uint64_t CameraCounters::*field) {
    if (now.*field > counted_.*field) writer_.count(counter, now.*field - counted_.*field);
  };
  add(Counter::frames_unreadable, &CameraCounters::unreadable);
  add(Counter::frames_wrong_size, &CameraCounters::mismatched);
  add(Counter::frames_overrun, &CameraCounters::overrun);
  add(Counter::frames_late, &CameraCounters::late);
  add(Counter::camera_reconnects, &CameraCounters::disconnected);
  counted_ = now;
}

}  // namespace linescope
