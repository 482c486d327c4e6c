// Behind a prism the laser's light is bent: rendered pictures, laser step, stored file, reconstruction. The
// truth is where the twin's rays meet its phantom.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "tests/integration/calibrate/twin_recordings.hpp"
#include "tools/calibrate/check_step.hpp"
#include "tools/calibrate/laser_fit.hpp"
#include "tools/calibrate/optical_steps.hpp"
#include "tools/calibrate/record_entry.hpp"

namespace linescope::calibrate {
namespace {

constexpr double kViews = 26;  ///< of the twin's forty, for time
constexpr double kMarginSquares = 6;

/// The twin's plate goes on around the pattern, so that the whole line is used and not only its middle.
std::unique_ptr<Step> laser_step() {
  auto step = make_laser_step();
  ConfigSchema schema;
  step->declare(schema);
  EXPECT_TRUE(schema.set(fmt::format("laser.margin_squares={}", kMarginSquares)));
  return step;
}

twin::TwinOptions behind_a_prism() {
  twin::TwinOptions o = uncalibrated_instrument(11);
  o.optics.prism.refracted_sheet = true;
  return o;
}

/// Swept over a plane at this distance, with nothing but the laser's surface to go wrong.
twin::TwinOptions scan_at(double gap_mm) {
  twin::TwinOptions o = behind_a_prism();
  o.optics = *twin::optics_from_name("ideal");
  o.optics.prism.refracted_sheet = true;
  o.tracker = *twin::tracker_noise_from_name("ideal");
  o.phantom = *twin::phantom_from_name("plane");
  o.hand.scenario = twin::Scenario::sweeps;
  o.hand.gap_mm = gap_mm;
  o.hand.gap_variation_mm = 1;
  o.instrument.frame_rate_hz = 8;
  return o;
}

struct Errors {
  double rms = 0, worst = 0;  ///< mm
  std::size_t points = 0;
};

Errors errors_of(const Recording& scan, const Calibration& calibration) {
  std::vector<LeftOut> left_out;
  const auto lines = placed_lines(scan.session, calibration, left_out);
  EXPECT_TRUE(lines);
  Errors e;
  for (const ScanLine& line : *lines) {
    for (const Eigen::Vector3d& p : line) {
      const double d = scan.experiment->truth().distance(p);
      e.rms += d * d;
      e.worst = std::max(e.worst, std::abs(d));
      ++e.points;
    }
  }
  e.rms = std::sqrt(e.rms / static_cast<double>(e.points));
  return e;
}

/// What the program does with an outcome: into the file, and back out of it.
Calibration stored(const Calibration& before, const Step& step, const Recording& recording) {
  const auto outcome = step.run(recording.session, printed_board(), before);
  EXPECT_TRUE(outcome) << outcome.error().message;
  EXPECT_FALSE(outcome->refused) << outcome->refused->message;
  for (const std::string& remark : outcome->quality.remarks) std::printf("%s\n", remark.c_str());
  const auto file = std::filesystem::temp_directory_path() /
                    ("linescope-bent-sheet-" + std::to_string(::getpid()) + ".yaml");
  const auto entry = make_entry("laser", "twin", recording.session.hash, outcome->method, outcome->quality);
  EXPECT_TRUE(store(file, before, entry, outcome->put));
  const auto back = load_calibration(file);
  std::filesystem::remove(file);
  EXPECT_TRUE(back) << back.error().message;
  return back.value_or(before);
}

TEST(BentSheet, IsStoredAndMeasuresWhereThePlaneDoesNot) {
  const auto step = laser_step();
  const auto views = recorded(before_board(behind_a_prism(), true), kViews, step->wants(printed_board()));
  ASSERT_TRUE(views) << views.error().message;
  Calibration before = views->experiment->calibration();
  before.laser = laser_plane_from_baseline(5, 0);  // the file knows nothing of the laser yet
  const Calibration bent = stored(before, *step, *views);
  EXPECT_FALSE(bent.laser_bend.flat());

  LaserFitOptions flat;
  flat.model = LaserModel::plane;
  flat.points.margin_squares = kMarginSquares;
  const auto plane = fit_laser(views->session, printed_board(), before.camera, flat);
  ASSERT_TRUE(plane) << plane.error().message;
  Calibration with_plane = before;
  with_plane.laser = plane->plane;

  for (const double gap : {10.0, 15.0, 20.0}) {
    const auto scan = recorded(scan_at(gap), 1.5, CheckStep().wants(printed_board()));
    ASSERT_TRUE(scan) << scan.error().message;
    const Errors by_bent = errors_of(*scan, bent), by_plane = errors_of(*scan, with_plane);
    std::printf(
        "gap %2.0f mm: bent %.4f mm RMS, %.4f mm at worst; plane %.4f mm RMS, %.4f mm at worst (%zu "
        "points)\n",
        gap, by_bent.rms, by_bent.worst, by_plane.rms, by_plane.worst, by_bent.points);
    EXPECT_GT(by_bent.points, 1500U);
    EXPECT_LT(by_bent.rms, 0.05);
    EXPECT_LT(by_bent.rms, 0.3 * by_plane.rms);
  }
}

/// A sheet that is flat must not be stored as bent.
TEST(BentSheet, AFlatOneStaysAPlane) {
  twin::TwinOptions o = behind_a_prism();
  o.optics.prism.refracted_sheet = false;
  const auto step = laser_step();
  const auto views = recorded(before_board(o, true), kViews / 2, step->wants(printed_board()));
  ASSERT_TRUE(views) << views.error().message;
  Calibration before = views->experiment->calibration();
  before.laser_bend.b[0] = 0.04;  // of the prism that was there before
  EXPECT_TRUE(stored(before, *step, *views).laser_bend.flat());
}

}  // namespace
}  // namespace linescope::calibrate
