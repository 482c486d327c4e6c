#include "tests/integration/calibrate/twin_recordings.hpp"

#include "acquire/twin/calibration_motion.hpp"
#include "acquire/twin/twin_camera.hpp"
#include "acquire/twin/twin_tracker.hpp"

namespace linescope::calibrate {

twin::TwinOptions uncalibrated_instrument(std::uint64_t seed) {
  twin::TwinOptions o = twin::demo_twin();  // preset manufacturer
  o.seed = seed;
  o.start = 5 * kSecond;
  o.tracker.field_position_mm = 0;
  o.tracker.field_rotation_rad = 0;
  o.instrument.latency = 12'300'000;
  o.instrument.harvester_tip = {-165.0, 12.0, -7.5};
  o.instrument.harvester_axis = Eigen::Vector3d(0.98, -0.09, 0.05).normalized();
  o.phantom = *twin::phantom_from_name("board");
  return o;
}

Result<Recording> recorded(const twin::TwinOptions& chosen, double seconds, const CollectOptions& wants,
                           bool pictures) {
  twin::TwinOptions options = chosen;
  options.duration = nanoseconds_from_seconds(seconds);
  auto experiment = twin::VirtualExperiment::create(options);
  if (!experiment) return tl::unexpected(experiment.error());
  Input input;
  if (pictures) input.camera = std::make_unique<twin::TwinCamera>(*experiment);
  input.tracker = std::make_unique<twin::TwinTracker>(*experiment);
  input.description = "digital twin";
  auto session = collect(input, wants);
  if (!session) return tl::unexpected(session.error());
  return Recording{*experiment, std::move(*session)};
}

twin::TwinOptions before_board(twin::TwinOptions o, bool laser) {
  o.hand.scenario = twin::Scenario::board;
  o.instrument.frame_rate_hz = 1 / (twin::kViewHoldSeconds + twin::kViewMoveSeconds);
  o.optics.light.led_brightness = laser ? 60 : 150;
  if (!laser) o.optics.line.brightness = 0;
  return o;
}

twin::TwinOptions shaken(twin::TwinOptions o) {
  o.hand.scenario = twin::Scenario::shake;
  o.optics.light.led_brightness = 150;
  o.optics.line.brightness = 0;
  return o;
}

BoardOptions printed_board() {
  BoardOptions options;
  options.square_mm = twin::BoardPattern{}.square_mm;
  return options;
}

}  // namespace linescope::calibrate
