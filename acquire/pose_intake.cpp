#include "acquire/pose_intake.hpp"

#include <spdlog/spdlog.h>

namespace linescope {
namespace {

constexpr Nanoseconds kReportEvery = 100 * kMillisecond;

SensorRole role_of(int station, const StationRoles& roles) {
  if (station == roles.endoscope) return SensorRole::endoscope;
  if (station == roles.object) return SensorRole::object;
  if (station == roles.harvester) return SensorRole::harvester;
  return SensorRole::other;
}

}  // namespace

PoseIntake::PoseIntake(const TrackerSource& tracker, const StationRoles& roles, PoseHistory& history,
                       SegmentWriter& writer)
    : tracker_(tracker), roles_(roles), history_(history), writer_(writer) {
  reported_.fill(ToolState::never_seen);
}

void PoseIntake::admit(const PoseSample& sample) {
  writer_.count(Counter::tracker_samples_received);
  if (sample.station >= kMaxStations) return writer_.count(Counter::tracker_samples_unknown_station);
  if (usable(sample.state) && !sample.world_from_sensor.finite())
    return writer_.count(Counter::tracker_samples_not_finite);
  if (!history_.add(sample)) return writer_.count(Counter::tracker_samples_out_of_order);
  if (sample.state == ToolState::distorted_field) writer_.count(Counter::tracker_samples_distorted);
  if (sample.state == ToolState::out_of_view) writer_.count(Counter::tracker_samples_out_of_view);
  if (sample.state == ToolState::ok) last_good_[sample.station] = sample.time;
  const Nanoseconds begin = monotonic_now();
  writer_.publish_pose(sample);
  const Nanoseconds end = monotonic_now();
  writer_.record_latency(LatencyStage::publish_pose, end - begin);
  if (end > sample.time) writer_.record_latency(LatencyStage::pose_total, end - sample.time);
}

void PoseIntake::take(const PoseSample& sample) {
  admit(sample);
  if (sample.station >= kMaxStations || sample.state == reported_[sample.station]) return;
  reported_[sample.station] = sample.state;
  report_station(sample.station, monotonic_now());
}

void PoseIntake::note(const Error& error) {
  complaint_ = error.message;
  spdlog::warn("tracker: {}", error.message);
}

void PoseIntake::report(Nanoseconds now) {
  if (now - last_report_ < kReportEvery) return;
  last_report_ = now;
  for (int station = 0; station < kMaxStations; ++station) report_station(station, now);
  report_device();
  count_losses();
}

void PoseIntake::report_station(int station, Nanoseconds now) {
  StationStatus s = tracker_.station(station);
  const SensorRole role = role_of(station, roles_);
  if (s.state == ToolState::never_seen && role == SensorRole::other) return;
  SensorStatus& out = outgoing_;
  out.role = role;
  out.state = s.state;
  out.time = now;
  out.last_good = last_good_[static_cast<std::size_t>(station)];
  out.samples = s.samples;
  out.lost = s.lost;
  out.nominal_hz = static_cast<float>(tracker_.nominal_hz());
  out.name = name(role);
  out.reason = s.reason.empty() && s.state != ToolState::ok ? complaint_ : std::move(s.reason);
  writer_.set_sensor_status(station, out);
}

/// The unit's own words go to the log when something happened to it; the residual of its clock is a figure.
void PoseIntake::report_device() {
  const TrackerFigures figures = tracker_.figures();
  if (figures.clock_residual > 0) writer_.record_latency(LatencyStage::tracker_clock, figures.clock_residual);
  const TrackerCounters now = tracker_.counters();
  if (!said_.empty() && now.reconnects == counted_.reconnects && now.device_errors == counted_.device_errors)
    return;
  const std::string sentence = tracker_.status().sentence;
  if (sentence.empty() || sentence == said_) return;
  said_ = sentence;
  spdlog::info("tracker: {}", sentence);
}

void PoseIntake::count_losses() {
  const TrackerCounters now = tracker_.counters();
  const auto add = [&](Counter counter, std::uint64_t TrackerCounters::*field) {
    if (now.*field > counted_.*field) writer_.count(counter, now.*field - counted_.*field);
  };
  add(Counter::tracker_samples_lost, &TrackerCounters::lost);
  add(Counter::tracker_samples_lost, &TrackerCounters::queue_overruns);
  add(Counter::tracker_samples_unreadable, &TrackerCounters::bad_records);
  add(Counter::tracker_samples_out_of_order, &TrackerCounters::out_of_order);
  add(Counter::tracker_reconnects, &TrackerCounters::reconnects);
  counted_ = now;
}

}  // namespace linescope
