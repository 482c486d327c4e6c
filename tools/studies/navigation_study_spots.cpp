#include "tools/studies/navigation_study_spots.hpp"

#include <algorithm>
#include <random>

#include "acquire/twin/twin_tracker.hpp"
#include "viewer/navigate/steady_harvester.hpp"
#include "viewer/navigation_worker.hpp"
#include "viewer/view_state.hpp"

namespace linescope::study {
namespace {

/// From arrival on a spot to departure.
struct Stay {
  Nanoseconds from = 0, to = 0;
};

std::vector<Stay> stays(const twin::VirtualExperiment& experiment) {
  const twin::TwinTruth& truth = experiment.truth();
  std::vector<Stay> all(truth.spots().size());
  std::size_t seen = 0;
  constexpr Nanoseconds kStep = 10 * kMillisecond, kLongest = 3600 * kSecond;
  for (Nanoseconds t = experiment.options().start; t < experiment.options().start + kLongest; t += kStep) {
    const int spot = truth.harvester(t).spot;
    if (spot < 0 && seen == all.size()) break;
    if (spot < 0) continue;
    Stay& stay = all[static_cast<std::size_t>(spot)];
    if (stay.from == 0) stay.from = t, ++seen;
    stay.to = t;
  }
  return all;
}

/// While the operator tilts, so that all angles occur.
std::vector<Nanoseconds> instants(const twin::VirtualExperiment& experiment) {
  std::mt19937_64 random(experiment.options().seed);
  std::uniform_real_distribution<double> share(0.2, 1.0);
  std::vector<Nanoseconds> result;
  for (const Stay& stay : stays(experiment))
    result.push_back(stay.from +
                     static_cast<Nanoseconds>(share(random) * static_cast<double>(stay.to - stay.from)));
  return result;
}

/// Walks along the axis by the distance to the surface, from outside.
Eigen::Vector3d where_axis_meets(const twin::TwinTruth& truth, const Eigen::Vector3d& tip,
                                 const Eigen::Vector3d& axis) {
  Eigen::Vector3d p = tip + 3 * axis;
  for (int i = 0; i < 100; ++i) p -= truth.distance(p) * axis;
  return p;
}

void know_truth(const twin::TwinTruth& truth, Nanoseconds time, Spot& spot) {
  const Rigid<Object, World> object_from_world = truth.world_from_object(time).inverse();
  const twin::HarvesterTruth harvester = truth.harvester(time);
  spot.true_axis = object_from_world.rotate(harvester.axis);
  spot.true_normal = truth.normal(where_axis_meets(truth, object_from_world * harvester.tip, spot.true_axis));
}

/// The newest poses, as the viewer's threads share them.
class NewestPoses {
 public:
  explicit NewestPoses(const Calibration& calibration) {
    live_.calibration_known = true;
    live_.harvester = calibration.harvester;
  }

  void take(const PoseSample& sample) {
    if (sample.station >= kToolRoles) return;
    ToolView& tool = live_.tools[sample.station];
    tool.state = sample.state;
    tool.acquired = sample.time;
    tool.world_from_sensor = sample.world_from_sensor;
    if (sample.station + 1 != kToolRoles) return;  // the harvester comes last in a cycle
    if (const auto held = held_harvester(live_)) steady_.follow(held->tip, held->axis, sample.time);
  }

  NormalQuery query(Nanoseconds now) {
    NormalQuery query{.tip = Eigen::Vector3d::Constant(NormalEstimate::kNone), .now = now};
    const auto held = held_harvester(live_);
    if (!held) return query;
    const auto& steady = steady_.follow(held->tip, held->axis, live_.tool(ToolRole::harvester).acquired);
    query.tip = steady.tip;
    query.axis = steady.axis;
    return query;
  }

 private:
  LiveView live_;
  SteadyHarvester steady_;
};

}  // namespace

std::vector<Spot> stand_on_spots(const std::shared_ptr<const twin::VirtualExperiment>& experiment,
                                 const Calibration& calibration) {
  twin::TwinTracker tracker(experiment);
  static_cast<void>(tracker.start());  // the twin's tracker always starts
  NewestPoses poses(calibration);
  std::vector<Spot> spots;
  PoseSample sample;
  for (const Nanoseconds due : instants(*experiment)) {
    while (sample.time < due) {
      auto pulled = tracker.next(sample);
      if (!pulled || *pulled != Pull::item) return spots;
      poses.take(sample);
    }
    Spot& spot = spots.emplace_back();
    spot.query = poses.query(sample.time);
    know_truth(experiment->truth(), sample.time, spot);
  }
  return spots;
}

}  // namespace linescope::study
