#include "tests/integration/calibrate/navigation_error.hpp"

#include <cmath>

#include "acquire/reconstruct/line_reconstructor.hpp"
#include "viewer/navigate/normal_estimator.hpp"

namespace linescope::calibrate {
namespace {

using Eigen::Vector3d;

/// The line in the object's frame; its points stay in `points`.
NavigationLine held_line(const ReconstructedLine& placed, const Rigid<Object, World>& object_from_world,
                         const Observation& picture, std::uint64_t id, std::vector<SurfacePoint>& points) {
  points = placed.points;
  for (SurfacePoint& p : points)
    p.position = (object_from_world * Vector3d(p.position.cast<double>())).cast<float>();
  return {id, picture.time, object_from_world.rotate(placed.viewing_direction.cast<double>()), points};
}

void add_lines(const Recording& recording, const Calibration& calibration, NormalEstimator& estimator) {
  const auto reconstructor = LineReconstructor::create(calibration, {});
  if (!reconstructor) return;
  const Session& session = recording.session;
  std::uint64_t id = 0;
  for (const Observation& picture : session.observations) {
    const auto endoscope = session.pose_at(0, picture.time, calibration.camera_latency);
    const auto object = session.pose_at(1, picture.time, calibration.camera_latency);
    if (!endoscope.ok() || !object.ok()) continue;
    ExtractedLine line;
    line.width = session.width;
    line.height = session.height;
    line.samples = picture.line;
    ReconstructedLine placed;
    if (!reconstructor->reconstruct(line, renamed<World, Endoscope>(endoscope.world_from_sensor), placed))
      continue;
    if (placed.points.empty()) continue;
    std::vector<SurfacePoint> points;
    const auto object_from_world = renamed<World, Object>(object.world_from_sensor).inverse();
    estimator.add_line(held_line(placed, object_from_world, picture, id++, points));
  }
}

}  // namespace

twin::TwinOptions navigating(twin::TwinOptions options) {
  options.phantom = *twin::phantom_from_name("condyle");
  options.hand.scenario = twin::Scenario::demo;
  options.hand.spots = 3;
  options.hand.tilt_seconds = 2;
  options.instrument.frame_rate_hz = 15;  // half as many pictures to render; lines enough
  return options;
}

NavigationError navigation_error(const Recording& recording, const Calibration& calibration) {
  NormalEstimator estimator;
  add_lines(recording, calibration, estimator);
  const Session& session = recording.session;
  const twin::TwinTruth& truth = recording.experiment->truth();
  const Nanoseconds start = recording.experiment->options().start;
  NavigationError error;
  double squares = 0;
  for (Nanoseconds t = start; t < start + nanoseconds_from_seconds(kNavigatingSeconds);
       t += 20 * kMillisecond) {
    const twin::HarvesterTruth real = truth.harvester(t);
    const auto harvester = session.pose_at(2, t), object = session.pose_at(1, t);
    if (real.spot < 0 || !harvester.ok() || !object.ok()) continue;
    const auto object_from_tool = renamed<World, Object>(object.world_from_sensor).inverse() *
                                  renamed<World, Harvester>(harvester.world_from_sensor);
    const NormalEstimate seen =
        estimator.estimate({.tip = object_from_tool * calibration.harvester.tip,
                            .axis = object_from_tool.rotate(calibration.harvester.axis),
                            .now = t});
    ++error.asked;
    if (!seen.good()) continue;
    ++error.shown;
    squares += std::pow(seen.angle - real.angle_to_normal_rad, 2);
  }
  error.rms_rad = std::sqrt(squares / std::max(1, error.shown));
  return error;
}

}  // namespace linescope::calibrate
