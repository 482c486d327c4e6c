#include "acquire/twin/twin_tracker.hpp"

#include <fmt/format.h>

#include <cmath>

#include "acquire/twin/liberty_bytes.hpp"

namespace linescope::twin {
namespace {

Rigid<World, Sensor> true_pose(const TwinTruth& truth, int station, Nanoseconds time) {
  switch (station) {
    case 0:
      return renamed<World, Sensor>(truth.world_from_endoscope(time));
    case 1:
      return renamed<World, Sensor>(truth.world_from_object(time));
    default:
      return renamed<World, Sensor>(truth.world_from_harvester(time));
  }
}

}  // namespace

TwinTracker::TwinTracker(std::shared_ptr<const VirtualExperiment> experiment)
    : experiment_(std::move(experiment)),
      noise_(experiment_->options().seed, experiment_->options().tracker) {
  liberty_.rate_hz = static_cast<int>(std::lround(experiment_->options().tracker.rate_hz));
  for (StationStatus& station : stations_) station.reason = "nothing arrived yet";
}

Result<void> TwinTracker::start() {
  const std::lock_guard lock(mutex_);
  stream_.emplace(liberty_);
  waiting_.clear();
  cycle_ = 0;
  started_ = true;
  ended_ = false;
  stations_ = {};
  counters_ = {};
  for (std::size_t i = kTwinStations; i < stations_.size(); ++i) {
    stations_[i].reason = "the digital twin has three sensors";
  }
  return {};
}

Result<Pull> TwinTracker::next(PoseSample& out) {
  if (!started_) return fail(ErrorCode::usage, "the simulated tracker was not started");
  while (waiting_.empty()) {
    if (over()) {
      const std::lock_guard lock(mutex_);
      ended_ = true;
      return Pull::end;
    }
    play_cycle();
  }
  out = waiting_.front();
  waiting_.pop_front();
  publish(out);
  return Pull::item;
}

bool TwinTracker::over() const {
  const Nanoseconds duration = experiment_->options().duration;
  return duration > 0 && std::llround(noise_.true_seconds(cycle_) * 1e9) >= duration;
}

void TwinTracker::play_cycle() {
  const double seconds = noise_.true_seconds(cycle_);
  const Nanoseconds time = experiment_->options().start + std::llround(seconds * 1e9);
  bytes_.clear();
  for (int station = 0; station < kTwinStations; ++station) append_station(station, seconds, time);
  stream_->feed(bytes_, time + liberty_.device_latency + noise_.lateness(cycle_), *this);
  ++cycle_;
}

void TwinTracker::append_station(int station, double seconds, Nanoseconds time) {
  LibertyRecord record;
  record.station = station;
  record.frame_count = static_cast<std::uint32_t>(cycle_);
  record.milliseconds = static_cast<std::uint32_t>(seconds * 1e3);
  if (noise_.dropped(station, seconds)) {
    record.error = kOutsideMappedArea;
  } else {
    record.world_from_sensor =
        noise_.reported(true_pose(experiment_->truth(), station, time), station, cycle_);
  }
  append_record(record, OutputList::for_options(liberty_), bytes_);
}

void TwinTracker::publish(const PoseSample& sample) {
  const std::lock_guard lock(mutex_);
  StationStatus& station = stations_[sample.station];
  station.state = sample.state;
  station.reason = usable(sample.state) ? "" : "simulated drop-out";
  station.last_sample = sample.time;
  ++station.samples;
  ++counters_.samples;
  const StreamCounters stream = stream_->counters();
  counters_.lost = stream.lost;
  counters_.bad_records = stream.parser.bad_records + stream.doubtful_counts;
  counters_.out_of_order = stream.out_of_order;
  counters_.device_errors = stream.device_errors;
}

std::string TwinTracker::description() const {
  const TwinOptions& options = experiment_->options();
  return fmt::format("digital twin, {} sensors at {:g} Hz, scenario {}, seed {}", kTwinStations,
                     options.tracker.rate_hz, name(options.hand.scenario), options.seed);
}

TrackerStatus TwinTracker::status() const {
  const std::lock_guard lock(mutex_);
  TrackerStatus status;
  status.delivering = started_ && !ended_;
  status.sentence = !started_ ? "not started"
                    : ended_  ? "the simulated experiment is over"
                              : "simulated samples";
  status.rate_hz = status.delivering ? experiment_->options().tracker.rate_hz : 0;
  return status;
}

StationStatus TwinTracker::station(int station) const {
  const std::lock_guard lock(mutex_);
  return stations_.at(static_cast<std::size_t>(station));
}

TrackerCounters TwinTracker::counters() const {
  const std::lock_guard lock(mutex_);
  return counters_;
}

}  // namespace linescope::twin
