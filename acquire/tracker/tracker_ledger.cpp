#include "acquire/tracker/tracker_ledger.hpp"

namespace linescope {

void TrackerLedger::count(const PoseSample& sample) {
  if (sample.station >= kMaxStations) return;
  const std::lock_guard lock(mutex_);
  ++books_.counters.samples;
  StationStatus& station = books_.stations[sample.station];
  ++station.samples;
  station.last_sample = sample.time;
}

void TrackerLedger::enter(const PoseSample& sample) {
  if (sample.station >= kMaxStations) return;
  count(sample);
  const std::lock_guard lock(mutex_);
  StationStatus& station = books_.stations[sample.station];
  if (station.state == sample.state) return;
  station.state = sample.state;
  station.reason = usable(sample.state) ? "" : std::string(name(sample.state));
}

TrackerStatus TrackerLedger::status() const {
  const std::lock_guard lock(mutex_);
  return books_.status;
}

TrackerFigures TrackerLedger::figures() const {
  const std::lock_guard lock(mutex_);
  return books_.status;
}

StationStatus TrackerLedger::station(int station) const {
  if (station < 0 || station >= kMaxStations) return {};
  const std::lock_guard lock(mutex_);
  return books_.stations[static_cast<std::size_t>(station)];
}

TrackerCounters TrackerLedger::counters() const {
  const std::lock_guard lock(mutex_);
  return books_.counters;
}

}  // namespace linescope
