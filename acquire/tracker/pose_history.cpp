#include "acquire/tracker/pose_history.hpp"

#include <fmt/format.h>

#include "acquire/tracker/pose_mean.hpp"

namespace linescope {
namespace {

/// The samples on both sides of an instant, or why there are none.
struct Neighbours {
  PoseMiss miss = PoseMiss::none;
  PoseSample before;
  PoseSample after;  ///< the same as `before` for an exact hit
  std::uint64_t after_index = 0;
};

/// Index of the first sample of [begin, end) taken at `time` or later; `end` when there is none. False when
/// overtaken.
bool first_not_before(const SampleRing& ring, std::uint64_t begin, std::uint64_t end, Nanoseconds time,
                      std::uint64_t& index) {
  while (begin < end) {
    const std::uint64_t middle = begin + (end - begin) / 2;
    Nanoseconds t = 0;
    if (!ring.read_time(middle, t)) return false;
    if (t < time)
      begin = middle + 1;
    else
      end = middle;
  }
  index = begin;
  return true;
}

/// False when the writer overtook us: ask again.
bool try_find(const SampleRing& ring, Nanoseconds time, Neighbours& out) {
  const std::uint64_t end = ring.end();
  const std::uint64_t begin = ring.begin(end);
  out.miss = PoseMiss::none;
  if (end == 0) return out.miss = PoseMiss::never_seen, true;
  if (!first_not_before(ring, begin, end, time, out.after_index)) return false;
  if (out.after_index == end) return out.miss = PoseMiss::too_late, true;
  if (!ring.read(out.after_index, out.after)) return false;
  out.before = out.after;
  if (out.after.time == time) return true;
  if (out.after_index == begin) return out.miss = PoseMiss::too_early, true;
  return ring.read(out.after_index - 1, out.before);
}

Neighbours find(const SampleRing& ring, Nanoseconds time) {
  Neighbours found;
  // The writer advances by one sample in milliseconds; a second overtaking within one search does not happen,
  // and if it did, the instant asked for is the oldest one kept.
  for (int attempt = 0; attempt < 8; ++attempt)
    if (try_find(ring, time, found)) return found;
  found.miss = PoseMiss::too_early;
  return found;
}

PoseAnswer missed(PoseMiss miss, ToolState state) {
  PoseAnswer answer;
  answer.miss = miss;
  answer.state = state;
  return answer;
}

}  // namespace

PoseAnswer pose_between(const PoseSample& a, const PoseSample& b, Nanoseconds time, Nanoseconds longest_gap) {
  PoseAnswer answer = missed(PoseMiss::none, worst(a.state, b.state));
  answer.gap = b.time - a.time;
  if (!usable(answer.state)) {
    answer.miss = PoseMiss::state_bad;
  } else if (answer.gap > longest_gap) {
    answer.miss = PoseMiss::gap_too_long;
  } else if (answer.gap == 0) {
    answer.world_from_sensor = b.world_from_sensor;
  } else {
    const double fraction = static_cast<double>(time - a.time) / static_cast<double>(answer.gap);
    answer.world_from_sensor = interpolate(a.world_from_sensor, b.world_from_sensor, fraction);
  }
  return answer;
}

Result<void> validate(const PoseHistoryOptions& options) {
  if (options.capacity < 2)
    return fail(ErrorCode::invalid,
                fmt::format("pose history: capacity is {}, it must be 2 or more", options.capacity));
  if (options.longest_gap <= 0)
    return fail(ErrorCode::invalid,
                fmt::format("pose history: longest_gap is {} ns, it must be positive", options.longest_gap));
  if (options.mean_over < 0 || options.mean_over > options.longest_gap)
    return fail(ErrorCode::invalid,
                fmt::format("pose history: mean_over is {} ns, it must be 0 to longest_gap, {} ns",
                            options.mean_over, options.longest_gap));
  return {};
}

std::string_view name(PoseMiss miss) {
  switch (miss) {
    case PoseMiss::none:
      return "pose known";
    case PoseMiss::never_seen:
      return "station never seen";
    case PoseMiss::too_early:
      return "older than the poses kept";
    case PoseMiss::too_late:
      return "newer than the last pose";
    case PoseMiss::gap_too_long:
      return "gap between poses too long";
    case PoseMiss::state_bad:
      return "pose not good";
  }
  return "unknown";
}

PoseHistory::PoseHistory(const PoseHistoryOptions& options) : options_(options) {
  for (auto& ring : rings_) ring = std::make_unique<SampleRing>(options.capacity);
}

bool PoseHistory::add(const PoseSample& sample) {
  const auto reject = [this] { return rejected_.fetch_add(1, std::memory_order_relaxed), false; };
  if (sample.station >= kMaxStations) return reject();
  SampleRing& ring = *rings_[sample.station];
  Nanoseconds last = 0;
  const std::uint64_t end = ring.end();
  if (end > 0 && ring.read_time(end - 1, last) && sample.time <= last) return reject();
  ring.push(sample);
  return true;
}

PoseAnswer PoseHistory::pose_at(int station, Nanoseconds time) const {
  if (station < 0 || station >= kMaxStations) return missed(PoseMiss::never_seen, ToolState::never_seen);
  const Neighbours found = find(*rings_[static_cast<std::size_t>(station)], time);
  switch (found.miss) {
    case PoseMiss::none:
      return pose_between(found.before, found.after, time, options_.longest_gap);
    case PoseMiss::never_seen:
      return missed(found.miss, ToolState::never_seen);
    default:
      return missed(found.miss, ToolState::stale);
  }
}

PoseAnswer PoseHistory::mean_pose(int station, Nanoseconds from, Nanoseconds to) const {
  PoseAnswer first = pose_at(station, from);
  if (!first.ok()) return first;
  const PoseAnswer last = pose_at(station, to);
  if (!last.ok()) return last;
  const SampleRing& ring = *rings_[static_cast<std::size_t>(station)];
  PoseSample sample;
  PoseMean<> mean;
  Nanoseconds previous = from;
  for (std::uint64_t i = find(ring, from).after_index; i < ring.end(); ++i) {
    if (!ring.read(i, sample)) return missed(PoseMiss::too_early, ToolState::stale);
    if (sample.time > to) break;
    if (!usable(sample.state)) return missed(PoseMiss::state_bad, sample.state);
    if (sample.time - previous > options_.longest_gap)
      return missed(PoseMiss::gap_too_long, ToolState::stale);
    previous = sample.time;
    mean.add(sample.world_from_sensor);
  }
  if (mean.count() == 0) return pose_at(station, from + (to - from) / 2);
  first.world_from_sensor = mean.value();
  return first;
}

bool PoseHistory::latest(int station, PoseSample& out) const {
  if (station < 0 || station >= kMaxStations) return false;
  const SampleRing& ring = *rings_[static_cast<std::size_t>(station)];
  for (int attempt = 0; attempt < 8; ++attempt) {
    const std::uint64_t end = ring.end();
    if (end == 0) return false;
    if (ring.read(end - 1, out)) return true;
  }
  return false;
}

}  // namespace linescope
