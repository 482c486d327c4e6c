#include "acquire/tool_poses.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "acquire/tracker/pose_mean.hpp"

namespace linescope {
namespace {

constexpr Nanoseconds kNever = std::numeric_limits<Nanoseconds>::min();

constexpr int kInstantsPerSide = 3;

template <class Tool>
LinePose<Tool> line_pose(const PoseAnswer& answer) {
  LinePose<Tool> pose;
  if (answer.ok()) {
    pose.world_from_tool = renamed<World, Tool>(answer.world_from_sensor);
    pose.state = ToolState::ok;
    return pose;
  }
  const bool never = answer.miss == PoseMiss::never_seen;
  pose.state = never ? ToolState::never_seen : worst(answer.state, ToolState::stale);
  if (answer.miss == PoseMiss::state_bad) pose.state = answer.state;
  return pose;
}

}  // namespace

Nanoseconds ToolPoseLookup::newest() const {
  Nanoseconds result = kNever;
  PoseSample sample;
  for (int station = 0; station < kMaxStations; ++station)
    if (history_.latest(station, sample)) result = std::max(result, sample.time);
  return result;
}

bool ToolPoseLookup::behind(int station, Nanoseconds time, Nanoseconds newest) const {
  PoseSample sample;
  if (station < 0 || !history_.latest(station, sample)) return true;
  return sample.time >= time || newest >= time + longest_wait_;
}

bool ToolPoseLookup::settled(Nanoseconds time) const {
  const Nanoseconds last = newest(), end = time + kInstantsPerSide * step_;
  if (last < end) return false;
  const std::array stations{roles_.endoscope, roles_.object, roles_.harvester};
  return std::all_of(stations.begin(), stations.end(), [&](int s) { return behind(s, end, last); });
}

PoseAnswer ToolPoseLookup::mean_about(int station, Nanoseconds time) const {
  PoseAnswer answer = history_.pose_at(station, time);
  if (!answer.ok() || step_ == 0) return answer;
  PoseMean<> mean;
  mean.add(answer.world_from_sensor);
  for (int k = 1; k <= kInstantsPerSide; ++k) {
    const PoseAnswer before = history_.pose_at(station, time - k * step_);
    const PoseAnswer after = history_.pose_at(station, time + k * step_);
    if (!before.ok() || !after.ok()) break;
    mean.add(before.world_from_sensor);
    mean.add(after.world_from_sensor);
  }
  answer.world_from_sensor = mean.value();
  return answer;
}

ToolPoses ToolPoseLookup::at(Nanoseconds time) const {
  const auto answer = [&](int station) { return station < 0 ? PoseAnswer{} : mean_about(station, time); };
  ToolPoses poses;
  poses.endoscope_answer = answer(roles_.endoscope);
  poses.endoscope = line_pose<Endoscope>(poses.endoscope_answer);
  poses.object = line_pose<Object>(answer(roles_.object));
  poses.harvester = line_pose<Harvester>(answer(roles_.harvester));
  return poses;
}

}  // namespace linescope
