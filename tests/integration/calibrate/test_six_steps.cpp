// A fresh endoscope: all six steps in their order, from rendered pictures and simulated tracker bytes only.
// Each step gets what the steps before it found. The truth is the twin's.
#include <gtest/gtest.h>

#include <cmath>

#include "acquire/twin/calibration_motion.hpp"
#include "common/units.hpp"
#include "tests/integration/calibrate/navigation_error.hpp"
#include "tests/integration/calibrate/twin_recordings.hpp"
#include "tools/calibrate/check_step.hpp"
#include "tools/calibrate/harvester_step.hpp"

namespace linescope::calibrate {
namespace {

using Eigen::Vector3d;

/// The programs' own steps, by name.
std::unique_ptr<Step> step_called(std::string_view name) {
  for (auto& step : all_steps()) {
    if (step->name() == name) return std::move(step);
  }
  ADD_FAILURE() << "no step is called " << name;
  return nullptr;
}

Recording must(Result<Recording> recording) {
  EXPECT_TRUE(recording) << recording.error().message;
  return recording ? std::move(*recording) : Recording{};
}

Recording record_for(const Step& step, const twin::TwinOptions& options, double seconds) {
  return must(recorded(options, seconds, step.wants(printed_board())));
}

/// Runs a step and puts what it found into the calibration; a refusal fails the test.
void run(const Step& step, const Recording& recording, Calibration& calibration) {
  const auto outcome = step.run(recording.session, printed_board(), calibration);
  ASSERT_TRUE(outcome) << step.name() << ": " << outcome.error().message;
  EXPECT_FALSE(outcome->refused) << step.name() << ": " << outcome->refused->message;
  const Quality& q = outcome->quality;
  std::printf("%-9s used %zu of %zu, residual %.4f, held out %.4f %s\n", std::string(step.name()).c_str(),
              q.used, q.offered, q.residual, q.held_out, q.unit.c_str());
  for (const Figure& f : q.parameters)
    std::printf("          %s %.5f +- %.5f %s\n", f.name.c_str(), f.value, f.deviation, f.unit.c_str());
  if (outcome->put) outcome->put(calibration);
}

void harvester(const twin::TwinOptions& instrument, Calibration& calibration) {
  for (const auto& [motion, scenario] :
       {std::pair{ToolMotion::spin, twin::Scenario::spin}, {ToolMotion::pivot, twin::Scenario::pivot}}) {
    twin::TwinOptions options = instrument;
    options.hand.scenario = scenario;
    HarvesterStep step;
    step.options().motion = motion;
    run(step, must(recorded(options, 16, {}, false)), calibration);
  }
}

twin::TwinOptions scanning(twin::TwinOptions options, const char* phantom) {
  options.phantom = *twin::phantom_from_name(phantom);
  options.hand.scenario = twin::Scenario::sweeps;
  return options;
}

/// Largest distance between two planes within the working range, and a bit beyond the line's ends.
double apart(const LaserPlane& a, const LaserPlane& b) {
  double most = 0;
  for (double z = 8; z <= 22; z += 1) {
    for (const double x : {-0.35, 0.0, 0.35}) {
      // y of plane b at that x and z
      const double y = (b.offset - b.normal.x() * x * z - b.normal.z() * z) / b.normal.y();
      most = std::max(most, std::abs(a.normal.dot(Vector3d(x * z, y, z)) - a.offset));
    }
  }
  return most;
}

void compare(const Calibration& found, const Calibration& truth) {
  EXPECT_NEAR(found.camera.fx / truth.camera.fx, 1, 0.002);
  EXPECT_NEAR(found.camera.fy / truth.camera.fy, 1, 0.002);
  EXPECT_LT(apart(found.laser, truth.laser), 0.05);
  const auto off = found.endoscope_from_camera.inverse() * truth.endoscope_from_camera;
  EXPECT_LT(off.translation().norm(), 0.1);
  EXPECT_LT(degrees_from_radians(off.rotation().angularDistance(Eigen::Quaterniond::Identity())), 0.1);
  EXPECT_LT((found.harvester.tip - truth.harvester.tip).norm(), 0.2);
  EXPECT_GT(found.harvester.axis.dot(truth.harvester.axis), std::cos(radians_from_degrees(0.2)));
  EXPECT_NEAR(milliseconds_from(found.camera_latency), milliseconds_from(truth.camera_latency), 1);
}

/// The figures as the page on calibrating quotes them.
void tell(const Calibration& found, const Calibration& truth) {
  const auto off = found.endoscope_from_camera.inverse() * truth.endoscope_from_camera;
  std::printf(
      "fx %+.3f %%, fy %+.3f %%; laser plane %.4f mm; hand-eye %.3f mm %.4f deg; tip %.4f mm, axis %.4f deg; "
      "latency %+.3f ms\n",
      100 * (found.camera.fx / truth.camera.fx - 1), 100 * (found.camera.fy / truth.camera.fy - 1),
      apart(found.laser, truth.laser), off.translation().norm(),
      degrees_from_radians(off.rotation().angularDistance(Eigen::Quaterniond::Identity())),
      (found.harvester.tip - truth.harvester.tip).norm(),
      degrees_from_radians(found.harvester.axis.cross(truth.harvester.axis).norm()),
      milliseconds_from(found.camera_latency - truth.camera_latency));
}

/// RMS distance of a scan's points from the true surface.
double true_error(const Recording& scan, const Calibration& calibration) {
  std::vector<LeftOut> left_out;
  const auto lines = placed_lines(scan.session, calibration, left_out);
  EXPECT_TRUE(lines);
  double squares = 0, count = 0;
  for (const ScanLine& line : *lines) {
    for (const Vector3d& p : line) {
      const double d = scan.experiment->truth().distance(p);
      squares += d * d;
      ++count;
    }
  }
  EXPECT_GT(count, 10000);
  return std::sqrt(squares / count);
}

/// A scan and a navigation with what was found must be no more than a fifth worse than with the truth.
void compare_use(const twin::TwinOptions& instrument, const Recording& cylinder, const Calibration& found,
                 const Calibration& truth) {
  const Recording plane = record_for(CheckStep(), scanning(instrument, "plane"), 5);
  for (const Recording* scan : {&plane, &cylinder}) {
    const double calibrated = true_error(*scan, found), best = true_error(*scan, truth);
    std::printf("%s: %.4f mm RMS calibrated, %.4f mm with the true parameters\n",
                scan == &plane ? "plane" : "cylinder", calibrated, best);
    EXPECT_LT(calibrated, 1.2 * best);
  }
  const Recording scan = record_for(CheckStep(), navigating(instrument), kNavigatingSeconds);
  const NavigationError calibrated = navigation_error(scan, found), best = navigation_error(scan, truth);
  std::printf("navigation: %.3f deg RMS calibrated (%d of %d), %.3f deg with the true parameters (%d)\n",
              degrees_from_radians(calibrated.rms_rad), calibrated.shown, calibrated.asked,
              degrees_from_radians(best.rms_rad), best.shown);
  EXPECT_GT(calibrated.shown, 100);
  EXPECT_LT(calibrated.rms_rad, 1.2 * best.rms_rad);
}

TEST(SixSteps, RecoverTheTruthAndMeasureAsWellAsTheTruthDoes) {
  const twin::TwinOptions instrument = uncalibrated_instrument(7);
  const auto camera = step_called("camera"), laser = step_called("laser"), hand_eye = step_called("hand-eye"),
             time = step_called("time");
  CheckStep check;
  check.shape().shape = Shape::cylinder;
  const Recording views = record_for(*camera, before_board(instrument, false), twin::kBoardViews);
  const Recording cylinder = record_for(check, scanning(instrument, "cylinder-50"), 8);
  const Calibration truth = views.experiment->calibration();

  Calibration found;
  found.name = "fresh";
  run(*camera, views, found);
  run(*laser, record_for(*laser, before_board(instrument, true), twin::kBoardViews), found);
  run(*hand_eye, views, found);
  harvester(instrument, found);
  run(*time, record_for(*time, shaken(instrument), 6), found);
  run(check, cylinder, found);

  tell(found, truth);
  compare(found, truth);
  compare_use(instrument, cylinder, found, truth);
}

}  // namespace
}  // namespace linescope::calibrate
