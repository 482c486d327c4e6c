// Closed forms, borders, gaps, layers, age: what the robust estimate answers and what it refuses.
#include <gtest/gtest.h>

#include "tests/unit/navigate/phantoms.hpp"
#include "viewer/navigate/angle_difference.hpp"

namespace linescope {
namespace {

using namespace phantom;

constexpr double kHundredth = 0.01 * std::numbers::pi / 180;

Noise silent() {
  return {.point = 1e-6, .drift = 0};
}

/// A surface, and the drift of the tracker that the estimate is told to expect: what is slower than a sweep
/// cannot be told from shape.
struct ClosedForm {
  Surface surface;
  double stated_drift;
};

class ClosedForms : public testing::TestWithParam<ClosedForm> {};

TEST_P(ClosedForms, WithoutNoiseTheErrorIsBelowAHundredthOfADegree) {
  const Surface& surface = GetParam().surface;
  Scanner scanner(1);
  Scan scan;
  scanner.sweep(surface, {}, silent(), 0, scan);
  NormalEstimatorOptions options;
  options.robust.solution.drift = GetParam().stated_drift;
  NormalEstimator estimator(options);
  add_all(estimator, scan);
  for (const double x : {-2.0, 0.0, 1.0})
    for (const double y : {-0.5, 0.0, 0.4}) {
      const PlacedSpot spot = spot_at(surface, x, y, radians_from_degrees(8), 3 * x + y, 0.7);
      const NormalEstimate e = estimator.estimate(spot.query);
      ASSERT_TRUE(e.good()) << name(e.reason) << " at " << x << ", " << y;
      EXPECT_LT(angle_difference(e.normal, spot.true_normal), kHundredth) << x << ", " << y;
      EXPECT_NEAR(e.angle, spot.angle, kHundredth);
      EXPECT_NEAR(e.depth, 0.7, 0.003);
      EXPECT_LT((e.foot - spot.foot).norm(), 0.003);
      const double up = std::abs(surface.value(e.nearest)) / surface.gradient(e.nearest).norm();
      EXPECT_LT(up, 0.003);
      // The nearest point is where the surface's normal points at the tip.
      EXPECT_LT(angle_difference(spot.query.tip - e.nearest, surface.normal(e.nearest)), 0.01);
      EXPECT_NEAR(e.distance, (spot.query.tip - e.nearest).norm(), 1e-6);
    }
}

std::string closed_form_name(const testing::TestParamInfo<ClosedForm>& test) {
  const std::string surface = test.param.surface.name.substr(0, test.param.surface.name.find(' '));
  return surface + (test.param.stated_drift > 0 ? "_usual_drift_stated" : "_no_drift_stated");
}
// The saddle alone needs to be told that nothing drifts: off its middle its cubic terms look like drift.
constexpr double kUsualDrift = SolutionOptions{}.drift;
INSTANTIATE_TEST_SUITE_P(Surfaces, ClosedForms,
                         testing::Values(ClosedForm{plane(), kUsualDrift}, ClosedForm{sphere(), kUsualDrift},
                                         ClosedForm{cylinder(), kUsualDrift}, ClosedForm{plane(), 0},
                                         ClosedForm{sphere(), 0}, ClosedForm{cylinder(), 0},
                                         ClosedForm{saddle(), 0}),
                         closed_form_name);

class Scanned : public testing::Test {
 protected:
  void scan(const Surface& surface, const Noise& noise, const std::function<bool(double, double)>& keep = {},
            Sweep sweep = {}) {
    Scan lines;
    scanner_.sweep(surface, sweep, noise, 0, lines, keep);
    add_all(estimator_, lines);
  }
  NormalReason reason_at(const Surface& surface, double x, double y) {
    return estimator_.estimate(spot_at(surface, x, y, 0.05, 1, 0.5).query).reason;
  }
  Scanner scanner_{5};
  NormalEstimator estimator_;
};

TEST_F(Scanned, RefusesAtEveryBorderAndAnswersInside) {
  scan(condyle(), {.line = 0.03});
  EXPECT_EQ(reason_at(condyle(), 0, 0), NormalReason::none);
  for (const auto& [x, y] :
       {std::pair{9.7, 0.0}, {-9.7, 0.0}, {0.0, 4.7}, {0.0, -4.7}, {9.8, 4.8}, {9.0, -4.6}})
    EXPECT_EQ(reason_at(condyle(), x, y), NormalReason::one_sided) << x << ", " << y;
}

TEST_F(Scanned, NeverAnswersOutsideOfTheScan) {
  scan(plane(), {.line = 0.03});
  for (double x = 10.05; x < 20; x += 0.4)
    for (const double y : {-3.0, 0.0, 3.0})
      EXPECT_NE(reason_at(plane(), x, y), NormalReason::none) << x << ", " << y;
}

TEST_F(Scanned, RefusesInAGapAndNamesIt) {
  scan(condyle(), {.line = 0.03}, [](double x, double y) { return std::hypot(x, y) > 1.6; });
  EXPECT_EQ(reason_at(condyle(), 0, 0), NormalReason::gap);
  EXPECT_EQ(reason_at(condyle(), 6, 0), NormalReason::none);
}

TEST_F(Scanned, RefusesWithTooFewLines) {
  scan(plane(), {.line = 0.03}, [](double x, double) { return std::abs(x) < 3; }, {.step = 1.5});
  EXPECT_EQ(reason_at(plane(), 0, 0), NormalReason::too_few_lines);
}

TEST_F(Scanned, RefusesWithTooFewPoints) {
  scan(plane(), {.line = 0.03}, {}, {.step = 0.8, .points_per_line = 20});
  EXPECT_EQ(reason_at(plane(), 0, 0), NormalReason::too_few_points);
}

TEST_F(Scanned, RefusesWhatIsTooOldAndTellsTheAge) {
  scan(plane(), {.line = 0.03});
  PlacedSpot spot = spot_at(plane(), 0, 0, 0.05, 0, 0.5);
  spot.query.now = 700 * kSecond;
  const NormalEstimate e = estimator_.estimate(spot.query);
  EXPECT_EQ(e.reason, NormalReason::too_old);
  EXPECT_GT(e.age, 690 * kSecond);
}

TEST_F(Scanned, RefusesWhatIsTooUncertainButKeepsTheNumbersForDiagnostics) {
  scan(plane(), {.line = 1.5});
  const NormalEstimate e = estimator_.estimate(spot_at(plane(), 0, 0, 0.05, 0, 0.5).query);
  EXPECT_EQ(e.reason, NormalReason::too_uncertain);
  EXPECT_GT(e.normal_uncertainty, radians_from_degrees(5));
}

/// Two rolls of 2.6 mm radius that meet in a crease along y.
Surface crease() {
  constexpr double kApart = 2.4, kRadius = 2.6;
  return {
      "crease",
      [](const Eigen::Vector3d& p) { return p.z() + std::pow(std::abs(p.x()) - kApart, 2) / (2 * kRadius); },
      [](const Eigen::Vector3d& p) {
        return Eigen::Vector3d(std::copysign(std::abs(p.x()) - kApart, p.x()) / kRadius, 0, 1);
      },
      5, 4};
}

TEST_F(Scanned, NoNormalBesideACreaseIsWrongByMoreThanItSays) {
  scan(crease(), {.line = 0.03});
  int refused = 0, answered = 0;
  for (const double x : {-2.4, -1.6, -1.2, -0.8, -0.6, -0.4, -0.2, 0.2, 0.4, 0.6, 0.8, 1.2, 1.6, 2.4}) {
    const PlacedSpot spot = spot_at(crease(), x, 0, 0.05, 0, 0.3);
    const NormalEstimate e = estimator_.estimate(spot.query);
    refused += e.reason == NormalReason::too_curved;
    if (!e.good()) continue;
    ++answered;
    EXPECT_LT(angle_difference(e.normal, spot.true_normal), e.normal_uncertainty) << x;
  }
  std::printf("crease: %d answered, %d refused as too strongly curved\n", answered, refused);
  EXPECT_GT(refused, 0);
}

// A tip that may be 3 mm off on a knee of 25 mm radius: the scan is good, the answer is not.
TEST(RobustNormal, RefusesWhatTheTrackerMakesTooUncertain) {
  Scanner scanner(5);
  Scan lines;
  scanner.sweep(condyle(), {}, {.line = 0.03}, 0, lines);
  for (const auto& [tip, reason] : {std::pair{0.1, NormalReason::none}, {3.0, NormalReason::too_uncertain}}) {
    NormalEstimatorOptions options;
    options.robust.unseen = {.surface_tilt = 0, .axis_tilt = 0, .tip = tip};
    NormalEstimator estimator(options);
    add_all(estimator, lines);
    EXPECT_EQ(estimator.estimate(spot_at(condyle(), 0, 0, 0.05, 0, 0.5).query).reason, reason) << tip;
  }
}

// Stated errors of the tracker widen the cone as the tilt they make: tip error times curvature.
TEST(RobustNormal, ConeGrowsWithWhatIsStatedOfTheTracker) {
  Scanner scanner(5);
  Scan lines;
  scanner.sweep(cylinder(), {}, {.line = 0.01}, 0, lines);
  const auto cone = [&](const Unseen& unseen) {
    NormalEstimatorOptions options;
    options.robust.unseen = unseen;
    NormalEstimator estimator(options);
    add_all(estimator, lines);
    return estimator.estimate(spot_at(cylinder(), 0, 0, 0.05, 0, 0.5).query).normal_uncertainty;
  };
  const double once = cone({.surface_tilt = 0, .axis_tilt = 0, .tip = 1});
  const double twice = cone({.surface_tilt = 0, .axis_tilt = 0, .tip = 2});
  EXPECT_NEAR(twice / once, 2, 0.05);
  // 1.96 deviations in the one direction that bends; up to 12 % more by Student's factor for fifty lines, the
  // scan's own drift and the cone's sixteen directions.
  EXPECT_GE(once, 1.96 / 25);
  EXPECT_LE(once, 1.12 * 1.96 / 25);
  // 2.45 where both directions tilt alike.
  EXPECT_NEAR(cone({.surface_tilt = 0.03, .axis_tilt = 0, .tip = 0}), 2.45 * 0.03, 0.1 * 2.45 * 0.03);
}

TEST(Unseen, AFieldWithoutDistortionAddsNothing) {
  const Unseen clear, made = Unseen::of_field(0, 0);
  EXPECT_EQ(made.surface_tilt, clear.surface_tilt);
  EXPECT_EQ(made.axis_tilt, clear.axis_tilt);
  EXPECT_EQ(made.tip, clear.tip);
  EXPECT_GT(Unseen::of_field(0.76, 0.0026).tip, 0.5);
}

TEST_F(Scanned, TellsAMissedSurfaceFromNone) {
  scan(plane(), {.line = 0.03});
  EXPECT_EQ(estimator_.estimate({{0, 0, 2}, {1, 0, 0}, 0}).reason, NormalReason::axis_misses_surface);
  EXPECT_EQ(estimator_.estimate({{300, 0, 0}, {0, 0, 1}, 0}).reason, NormalReason::no_surface);
  EXPECT_EQ(NormalEstimator().estimate({{0, 0, 0}, {0, 0, 1}, 0}).reason, NormalReason::no_surface);
}

TEST_F(Scanned, RefusesAPoseThatIsNone) {
  scan(plane(), {.line = 0.03});
  const double nan = std::nan("");
  for (const NormalMethod method : {NormalMethod::robust, NormalMethod::algorithm_1}) {
    EXPECT_EQ(estimator_.estimate({{nan, 0, 0}, {0, 0, 1}, 0}, method).reason, NormalReason::bad_query);
    EXPECT_EQ(estimator_.estimate({{0, 0, 0}, {0, 0, 0}, 0}, method).reason, NormalReason::bad_query);
    EXPECT_EQ(estimator_.estimate({{0, 0, 0}, {0, nan, 1}, 0}, method).reason, NormalReason::bad_query);
    EXPECT_EQ(estimator_.estimate({{1e30, 0, 0}, {0, 0, 1}, 0}, method).reason, NormalReason::bad_query);
  }
}

TEST_F(Scanned, FindsTheSurfaceAheadAndBehindTheTip) {
  scan(condyle(), {.line = 0.03});
  for (const double height : {-3.0, 0.0, 8.0, 15.0}) {
    const NormalEstimate e = estimator_.estimate(spot_at(condyle(), 1, 0.5, 0.1, 2, height).query);
    ASSERT_TRUE(e.good()) << height << name(e.reason);
    EXPECT_NEAR(e.depth, height, 0.1);
  }
}

TEST_F(Scanned, WildPointsAreLeftOutAndCounted) {
  scan(condyle(), {.line = 0.03, .wild = 0.2});
  const PlacedSpot spot = spot_at(condyle(), 1, 0.5, 0.1, 2, 0.5);
  const NormalEstimate e = estimator_.estimate(spot.query);
  ASSERT_TRUE(e.good()) << name(e.reason);
  EXPECT_LT(angle_difference(e.normal, spot.true_normal), radians_from_degrees(1));
  EXPECT_GT(e.counts.points_rejected, 500);
}

TEST_F(Scanned, AFlapOfTissueBesideTheFootDoesNotTiltTheNormal) {
  Scan lines;
  scanner_.sweep(condyle(), {}, {.line = 0.05}, 0, lines);
  for (ScannedLine& line : lines)
    for (SurfacePoint& p : line.points)
      if (p.position.x() > 2.0f) p.position.z() += 1.5f;
  add_all(estimator_, lines);
  const PlacedSpot spot = spot_at(condyle(), 0, 0, 0.1, 2, 0.5);
  const NormalEstimate e = estimator_.estimate(spot.query);
  ASSERT_TRUE(e.good()) << name(e.reason);
  EXPECT_LT(angle_difference(e.normal, spot.true_normal), radians_from_degrees(2));
}

TEST_F(Scanned, MovingTheFrameMovesNothingElse) {
  // The object's frame may lie anywhere: all results turn and shift with it.
  const Eigen::Isometry3d away =
      Eigen::Translation3d(120, -80, 45) * Eigen::AngleAxisd(2.1, Eigen::Vector3d(1, 2, 3).normalized());
  Scan lines;
  scanner_.sweep(condyle(), {}, {.line = 0.05}, 0, lines);
  NormalEstimator moved;
  add_all(estimator_, lines);
  for (ScannedLine& line : lines) {
    line.view = away.linear() * line.view;
    for (SurfacePoint& p : line.points) p.position = (away * p.position.cast<double>()).cast<float>();
  }
  add_all(moved, lines);
  const PlacedSpot spot = spot_at(condyle(), 1, 0.5, 0.1, 2, 0.5);
  const NormalEstimate a = estimator_.estimate(spot.query);
  const NormalEstimate b =
      moved.estimate({away * spot.query.tip, away.linear() * spot.query.axis, spot.query.now});
  ASSERT_TRUE(a.good() && b.good());
  // Another grid cuts other segments at the patch's rim: the same up to a small part of the uncertainty.
  EXPECT_LT(angle_difference(away.linear() * a.normal, b.normal), 0.3 * a.normal_uncertainty);
}

TEST(RobustNormalOptions, FaultsAreNamed) {
  EXPECT_TRUE(validate(NormalEstimatorOptions{}).has_value());
  const auto refused = [](auto change) {
    NormalEstimatorOptions options;
    change(options);
    const auto result = validate(options);
    return !result && !result.error().message.empty();
  };
  EXPECT_TRUE(refused([](auto& o) { o.robust.radius = 0.1; }));
  EXPECT_TRUE(refused([](auto& o) { o.robust.height = -1; }));
  EXPECT_TRUE(refused([](auto& o) { o.robust.curvature_reach = 0; }));
  EXPECT_TRUE(refused([](auto& o) { o.robust.unseen.surface_tilt = NAN; }));
  EXPECT_TRUE(refused([](auto& o) { o.robust.robust.cut = 0; }));
  EXPECT_TRUE(refused([](auto& o) { o.robust.foot.reach_ahead = -1; }));
  EXPECT_TRUE(refused([](auto& o) { o.robust.support.fewest_lines = 1; }));
  EXPECT_TRUE(refused([](auto& o) { o.robust.support.oldest = 0; }));
  EXPECT_TRUE(refused([](auto& o) { o.index.cell_size = 0; }));
  EXPECT_TRUE(refused([](auto& o) { o.index.segments_per_cell = 1; }));
  EXPECT_TRUE(refused([](auto& o) { o.index.cells = 1; }));
  EXPECT_TRUE(refused([](auto& o) { o.index.plane_reach = 9; }));
  EXPECT_TRUE(refused([](auto& o) { o.index.plane_points = 1; }));
}

}  // namespace
}  // namespace linescope
