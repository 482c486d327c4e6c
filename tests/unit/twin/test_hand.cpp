// The simulated operator: gaps, coverage, out of view between scans, the harvester on its spots.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "acquire/twin/hand_motion.hpp"
#include "acquire/twin/timeline.hpp"
#include "common/units.hpp"
#include "picture_line.hpp"
#include "twin_fixture.hpp"

namespace linescope::twin {
namespace {

using Eigen::Vector3d;

constexpr Nanoseconds kRound = 45 * kSecond;  // a bit more than one round of the demo

// Distance along the optical axis.
double gap(const TwinTruth& truth, Nanoseconds time) {
  const auto camera = truth.phantom_from_camera(time);
  Hit hit;
  if (!truth.phantom().cast(camera.translation(), camera.rotate(Vector3d::UnitZ()), hit)) return -1;
  return hit.distance;
}

TEST(Hand, SweepsAtGapsOfTenToTwenty) {
  const auto twin = experiment(demo_twin());
  double least = 1e9, most = 0, sum = 0;
  int count = 0;
  for (Nanoseconds t = 0; t < kRound; t += 20 * kMillisecond) {
    if (!twin->truth().scanning(t)) continue;
    const double now = gap(twin->truth(), t);
    least = std::min(least, now);
    most = std::max(most, now);
    sum += now;
    ++count;
  }
  EXPECT_GT(count, 400);
  EXPECT_GT(least, 9.5);
  EXPECT_LT(most, 20.5);
  EXPECT_GT(most - least, 4) << "a hand does not keep its distance";
  EXPECT_NEAR(sum / count, 15, 1.0);
}

TEST(Hand, LineCoversTheDonorSite) {
  const auto twin = experiment(demo_twin());
  const TwinTruth& truth = twin->truth();
  double least = 1e9, most = -1e9;
  for (Nanoseconds t = 0; t < kRound; t += 10 * kMillisecond) {
    if (!truth.scanning(t)) continue;
    // The line meets the surface at y_up = b - gap tan(alpha) beside the axis.
    const auto camera = truth.phantom_from_camera(t);
    const double z = gap(truth, t);
    const Vector3d line = camera * Vector3d(0, z * std::tan(radians_from_degrees(14)) - 6, z);
    least = std::min(least, line.x());
    most = std::max(most, line.x());
  }
  EXPECT_LT(least, -12.5);
  EXPECT_GT(most, 12.5);
}

TEST(Hand, MovesSmoothly) {
  const auto twin = experiment(demo_twin());
  Vector3d last = twin->truth().world_from_camera(0).translation();
  for (Nanoseconds t = kMillisecond; t < kRound; t += kMillisecond) {
    const Vector3d now = twin->truth().world_from_camera(t).translation();
    // 0.5 m/s is a quick hand; a jump at a phase's border would be far more.
    ASSERT_LT((now - last).norm(), 0.5) << "at " << seconds_from(t) << " s";
    last = now;
  }
}

TEST(Hand, NothingOfTheLaserIsSeenWhileTheEndoscopeRests) {
  TwinOptions options = demo_twin();
  options.hand.sweeps = 1;
  options.hand.sweep_seconds = 1.0;
  const auto frames = pictures(options, 120);
  int lit = 0;
  for (const Frame& frame : frames) {
    const double s = seconds_from(frame.time);
    if (s > 2.8) {
      EXPECT_EQ(laser_pixels(frame.bgr), 0) << s;
    }
    if (s > 0.9 && s < 1.7) lit += laser_pixels(frame.bgr) > 200;
  }
  EXPECT_GT(lit, 20);
}

TEST(Hand, HarvesterTurnsTowardsTheNormalOnEverySpot) {
  const auto twin = experiment(demo_twin());
  const TwinTruth& truth = twin->truth();
  const double start = twin->options().hand.tilt_start_rad;
  std::set<int> begun, done;
  for (Nanoseconds t = 0; t < kRound; t += 20 * kMillisecond) {
    const HarvesterTruth now = truth.harvester(t);
    if (now.spot < 0) continue;
    const MarkedSpot& spot = truth.spots()[static_cast<std::size_t>(now.spot)];
    const auto object_from_world = truth.world_from_object(t).inverse();
    EXPECT_LT((object_from_world * now.tip - spot.position).norm(), 0.2) << "the tip rests on the spot";
    const double angle = std::acos(std::min(1.0, object_from_world.rotate(now.axis).dot(spot.normal)));
    EXPECT_NEAR(angle, now.angle_to_normal_rad, 1e-7);
    if (angle > 0.8 * start) begun.insert(now.spot);
    if (angle < radians_from_degrees(1.5)) done.insert(now.spot);
  }
  EXPECT_EQ(begun.size(), 5u);
  EXPECT_EQ(done.size(), 5u);
}

TEST(Hand, SpotsLieOnTheSurfaceWithItsNormal) {
  TwinOptions options = ideal_twin("cylinder-50", Scenario::spots);
  options.hand.spots = 30;
  const auto twin = experiment(options);
  ASSERT_EQ(twin->truth().spots().size(), 30u);
  for (const MarkedSpot& spot : twin->truth().spots()) {
    EXPECT_NEAR(twin->truth().distance(spot.position), 0, 1e-9);
    // Closed form: 2 mm along the normal is 2 mm from the surface.
    EXPECT_NEAR(twin->truth().distance(spot.position + 2 * spot.normal), 2, 1e-9);
    EXPECT_NEAR((twin->truth().normal(spot.position) - spot.normal).norm(), 0, 1e-9);
  }
}

TEST(Hand, HarvesterPoseCarriesTipAndAxisOfTheCalibration) {
  const auto twin = experiment(demo_twin());
  const Calibration calibration = twin->calibration();
  for (const Nanoseconds t : {Nanoseconds{0}, 14 * kSecond, 20 * kSecond}) {
    const auto pose = twin->truth().world_from_harvester(t);
    const HarvesterTruth truth = twin->truth().harvester(t);
    EXPECT_NEAR((pose * calibration.harvester.tip - truth.tip).norm(), 0, 1e-9);
    EXPECT_NEAR((pose.rotate(calibration.harvester.axis) - truth.axis).norm(), 0, 1e-9);
  }
}

TEST(Hand, ObjectMovesOnlyWhenAsked) {
  TwinOptions options = demo_twin();
  const auto still = experiment(options);
  EXPECT_EQ(still->truth().world_from_object(0).translation(),
            still->truth().world_from_object(kRound).translation());
  options.hand.object_drift_mm = 2.0;
  const auto moving = experiment(options);
  double most = 0;
  for (Nanoseconds t = 0; t < kRound; t += kSecond) {
    most = std::max(most, (moving->truth().world_from_object(t).translation() -
                           still->truth().world_from_object(0).translation())
                              .norm());
  }
  EXPECT_GT(most, 1.0);
  EXPECT_LT(most, 8.0);
}

TEST(Timeline, PhasesFollowAndRepeat) {
  HandOptions options;
  options.spots = 1;
  const Timeline timeline(options);
  EXPECT_EQ(timeline.at(0).phase, Phase::approach);
  EXPECT_EQ(timeline.at(1).phase, Phase::sweep);
  EXPECT_EQ(timeline.at(11).phase, Phase::withdraw);
  EXPECT_EQ(timeline.at(12).phase, Phase::travel);
  EXPECT_EQ(timeline.at(14).phase, Phase::tilt);
  EXPECT_EQ(timeline.at(17.5).phase, Phase::hold);
  EXPECT_EQ(timeline.at(timeline.round() - 0.1).phase, Phase::leave);
  EXPECT_EQ(timeline.at(timeline.round() + 1).phase, Phase::sweep);
}

TEST(Tremor, HasTheStatedAmplitude) {
  const Tremor tremor(1, 0, 0.1, 0.6);
  double squares = 0;
  constexpr int kCount = 20000;
  for (int i = 0; i < kCount; ++i) squares += tremor.at(i * 0.01).squaredNorm();
  // Sines of amplitude A per axis have a mean square of A^2 / 2 on each of three axes.
  EXPECT_NEAR(std::sqrt(squares / kCount), std::sqrt(1.5 * (0.1 * 0.1 + 0.6 * 0.6)), 0.05);
}

}  // namespace
}  // namespace linescope::twin
