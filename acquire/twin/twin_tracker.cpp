#include "acquire/twin/twin_tracker.hpp"

#include <fmt/format.h>

#include <cmath>

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
  for (StationStatus& station : stations_) station.reason = "nothing arrived yet";
}

Result<void> TwinTracker::start() {
  const std::lock_guard lock(mutex_);
  cycle_ = 0;
  next_station_ = 0;
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
  const TwinOptions& options = experiment_->options();
  const double seconds = noise_.true_seconds(cycle_);
  const Nanoseconds time = options.start + std::llround(seconds * 1e9);
  if (options.duration > 0 && time >= options.start + options.duration) {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    return Pull::end;
  }
  out = PoseSample{};
  out.time = time + noise_.stamp_error(cycle_);
  out.frame_count = static_cast<std::uint32_t>(cycle_);
  out.station = static_cast<std::uint8_t>(next_station_);
  if (noise_.dropped(next_station_, seconds)) {
    out.state = ToolState::out_of_view;
  } else {
    out.state = ToolState::ok;
    out.world_from_sensor =
        noise_.reported(true_pose(experiment_->truth(), next_station_, time), next_station_, cycle_);
  }
  publish(out);
  next_station_ = (next_station_ + 1) % kTwinStations;
  if (next_station_ == 0) ++cycle_;
  return Pull::item;
}

void TwinTracker::publish(const PoseSample& sample) {
  const std::lock_guard lock(mutex_);
  StationStatus& station = stations_[sample.station];
  station.state = sample.state;
  station.reason = usable(sample.state) ? "" : "simulated drop-out";
  station.last_sample = sample.time;
  ++station.samples;
  ++counters_.samples;
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
