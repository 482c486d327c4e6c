#include "tools/evaluate/navigation_study.hpp"

#include <algorithm>

#include "tools/evaluate/setups.hpp"
#include "tools/evaluate/surfaces.hpp"

namespace linescope::evaluate {
namespace {

constexpr double kPoseEvery = 0.01;  // s, how finely the time is searched for instants on a spot

twin::TwinOptions scan_options(const Form& form, std::uint64_t seed) {
  twin::TwinOptions options = sweeping_freely(system_ii(seed), form.scan_seconds);
  options.phantom = phantom("cylinder-50");
  options.hand.spots = form.spots;
  return options;
}

/// The same operating theatre, after the scan: harvester from spot to spot.
twin::TwinOptions spot_options(const Form& form, std::uint64_t seed) {
  twin::TwinOptions options = scan_options(form, seed);
  options.hand.scenario = twin::Scenario::spots;
  options.hand.tilt_start_rad =
      options.hand.tilt_end_rad;  // the pose is taken when the operator is satisfied
  options.hand.tilt_seconds = 0.1;
  const double per_spot = 1.2 + options.hand.tilt_seconds + 1.0;
  options.duration = nanoseconds_from_seconds(per_spot * form.spots);
  return options;
}

/// Middle of the time for which the harvester stands on each spot.
std::vector<Nanoseconds> instants(const twin::TwinTruth& truth, int spots, Nanoseconds duration) {
  std::vector<Nanoseconds> first(static_cast<std::size_t>(spots), -1), last = first;
  for (Nanoseconds t = 0; t < duration; t += nanoseconds_from_seconds(kPoseEvery)) {
    const int spot = truth.harvester(t).spot;
    if (spot < 0 || spot >= spots) continue;
    const auto i = static_cast<std::size_t>(spot);
    if (first[i] < 0) first[i] = t;
    last[i] = t;
  }
  std::vector<Nanoseconds> middle;
  for (std::size_t i = 0; i < first.size(); ++i)
    if (first[i] >= 0) middle.push_back((first[i] + last[i]) / 2);
  return middle;
}

const PoseSample* sample_at(const std::vector<PoseSample>& samples, Nanoseconds time) {
  const auto after = std::lower_bound(samples.begin(), samples.end(), time,
                                      [](const PoseSample& s, Nanoseconds t) { return s.time < t; });
  if (after == samples.end() || !usable(after->state)) return nullptr;
  return &*after;
}

/// The true axis may run past the marked spot by the operator's tremor: the true normal is taken where it
/// meets the surface.
Spot spot_at(const VirtualSession& session, const PoseSample& harvester, const PoseSample& object) {
  const Calibration calibration = session.calibration();
  const twin::TwinTruth& truth = session.truth();
  const auto object_from_harvester = renamed<World, Object>(object.world_from_sensor).inverse() *
                                     renamed<World, Harvester>(harvester.world_from_sensor);
  const twin::HarvesterTruth real = truth.harvester(harvester.time);
  const auto object_from_world = truth.world_from_object(harvester.time).inverse();
  Spot spot;
  spot.query.tip = object_from_harvester * calibration.harvester.tip;
  spot.query.axis = object_from_harvester.rotate(calibration.harvester.axis);
  spot.query.now = harvester.time;
  spot.true_axis = object_from_world.rotate(real.axis);
  spot.true_normal = truth.normal(object_from_world * real.tip);
  return spot;
}

Result<std::vector<Spot>> spots_of(const Form& form, std::uint64_t seed) {
  const twin::TwinOptions options = spot_options(form, seed);
  auto session = VirtualSession::without_pictures(options);
  if (!session) return tl::unexpected(session.error());
  SessionOptions run;
  run.pose_history = 32'768;  // 136 s
  auto acquired = session->acquire(run);
  if (!acquired) return tl::unexpected(acquired.error());
  const auto& harvester = acquired->poses[static_cast<std::size_t>(ToolRole::harvester)];
  const auto& object = acquired->poses[static_cast<std::size_t>(ToolRole::object)];
  std::vector<Spot> spots;
  for (const Nanoseconds t : instants(session->truth(), form.spots, options.duration)) {
    const PoseSample* tool = sample_at(harvester, t);
    const PoseSample* base = sample_at(object, t);
    if (tool != nullptr && base != nullptr) spots.push_back(spot_at(*session, *tool, *base));
  }
  return spots;
}

/// The thesis's normal belongs to the thesis's column.
NormalMethod normal_of(MeshMethod column) {
  return column == kThesisMesh ? NormalMethod::algorithm_1 : NormalMethod::robust;
}

}  // namespace

Result<NavigationOutcome> navigation_experiment(const Form& form, std::uint64_t seed) {
  auto spots = spots_of(form, seed);
  if (!spots) return tl::unexpected(spots.error());
  // The scan is a little older than the spots; its age is not what is asked for here.
  for (Spot& spot : *spots) spot.query.now = nanoseconds_from_seconds(form.scan_seconds);
  return both_columns(scan_options(form, seed),
                      [&](const VirtualSession& session, const SessionOptions& algorithms,
                          MeshMethod column) -> Result<SpotReport> {
                        auto scan = session.acquire(algorithms);
                        if (!scan) return tl::unexpected(scan.error());
                        return run_spots(estimator_of(scan->lines), *spots, normal_of(column));
                      });
}

}  // namespace linescope::evaluate
