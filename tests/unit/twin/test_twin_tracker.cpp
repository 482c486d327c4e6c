// The simulated LIBERTY: rate, clock, noise of each kind, and that its errors have the stated size.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "common/euler.hpp"
#include "common/units.hpp"
#include "twin_fixture.hpp"

namespace linescope::twin {
namespace {

using Eigen::Vector3d;

Rigid<World, Sensor> truth_of(const VirtualExperiment& twin, const PoseSample& sample, Nanoseconds time) {
  const TwinTruth& truth = twin.truth();
  if (sample.station == 0) return renamed<World, Sensor>(truth.world_from_endoscope(time));
  if (sample.station == 1) return renamed<World, Sensor>(truth.world_from_object(time));
  return renamed<World, Sensor>(truth.world_from_harvester(time));
}

Vector3d rotation_error(const Rigid<World, Sensor>& truth, const Rigid<World, Sensor>& sample) {
  const Eigen::AngleAxisd turn(truth.rotation().conjugate() * sample.rotation());
  const double angle = turn.angle() > std::numbers::pi ? turn.angle() - 2 * std::numbers::pi : turn.angle();
  return angle * turn.axis();
}

struct Spread {
  double position = 0, rotation = 0;  ///< RMS per axis
};

Spread spread(const TwinOptions& options, int count) {
  const auto twin = experiment(options);
  Spread sum;
  for (const PoseSample& sample : samples(options, count)) {
    const auto truth = truth_of(*twin, sample, sample.time);
    sum.position += (sample.world_from_sensor.translation() - truth.translation()).squaredNorm() / 3;
    sum.rotation += rotation_error(truth, sample.world_from_sensor).squaredNorm() / 3;
  }
  return {std::sqrt(sum.position / count), std::sqrt(sum.rotation / count)};
}

TEST(TwinTracker, ThreeStationsIn240CyclesPerSecondInTimeOrder) {
  const auto all = samples(ideal_twin(), 3 * 241);
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(all[i].station, i % 3);
    EXPECT_EQ(all[i].frame_count, i / 3);
    EXPECT_EQ(all[i].state, ToolState::ok);
  }
  // The clock fit works in doubles: a nanosecond or two.
  EXPECT_NEAR(static_cast<double>(all[3 * 240].time - all[0].time), 1e9, 3);
}

// A LIBERTY sends centimetres as 32-bit floats: half a unit in the last place is 2e-5 mm at 350 mm, and 3e-8
// of a quaternion.
TEST(TwinTracker, IdealSamplesAreTheTruthToTheLastBitOfTheWire) {
  const Spread error = spread(ideal_twin("condyle", Scenario::demo), 9000);
  EXPECT_LT(error.position, 3e-5);
  EXPECT_GT(error.position, 1e-8) << "went past the wire";
  EXPECT_LT(error.rotation, 2e-7);
}

TEST(TwinTracker, WhiteNoiseHasTheStatedSize) {
  TwinOptions options = ideal_twin("condyle", Scenario::demo);
  options.tracker.position_sigma_mm = 0.25;
  options.tracker.rotation_sigma_rad = radians_from_degrees(0.1);
  // 9000 numbers: the standard deviation of a standard deviation is 0.75 %, four of them 3 %.
  const Spread error = spread(options, 3000);
  EXPECT_NEAR(error.position, 0.25, 0.03 * 0.25);
  EXPECT_NEAR(error.rotation, radians_from_degrees(0.1), 0.03 * radians_from_degrees(0.1));
}

// The manufacturer's static accuracy is a mean over space: many seeds stand for many places.
TEST(TwinTracker, FieldDistortionHasTheStatedRmsOverPlaces) {
  double position = 0, rotation = 0;
  constexpr int kSeeds = 400;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    TrackerNoise noise;
    noise.field_position_mm = 0.76;
    noise.field_rotation_rad = radians_from_degrees(0.15);
    const TrackerNoiseModel model(seed, noise);
    const Rigid<World, Sensor> truth(Eigen::Quaterniond::Identity(), Vector3d(300, 40, -80));
    const auto sample = model.reported(truth, 0, 0);
    position += (sample.translation() - truth.translation()).squaredNorm();
    rotation += rotation_error(truth, sample).squaredNorm();
  }
  EXPECT_NEAR(std::sqrt(position / kSeeds), 0.76, 0.05);
  EXPECT_NEAR(std::sqrt(rotation / kSeeds), radians_from_degrees(0.15), radians_from_degrees(0.01));
}

TEST(TwinTracker, FieldDistortionDependsOnThePlaceAlone) {
  TrackerNoise noise;
  noise.field_position_mm = 0.76;
  const TrackerNoiseModel model(4, noise);
  const auto error_at = [&](const Vector3d& place, std::uint64_t cycle, int station) {
    return Vector3d(model.reported({Eigen::Quaterniond::Identity(), place}, station, cycle).translation() -
                    place);
  };
  const Vector3d here(300, 0, 0), near(300, 5, 0), far(300, 125, 60);
  EXPECT_EQ(error_at(here, 0, 0), error_at(here, 999, 2));
  EXPECT_LT((error_at(here, 0, 0) - error_at(near, 0, 0)).norm(), 0.2) << "slow over space";
  EXPECT_GT((error_at(here, 0, 0) - error_at(far, 0, 0)).norm(), 0.05);
}

TEST(TwinTracker, QuantisesPositionAndAngles) {
  TrackerNoise noise;
  noise.position_step_mm = 0.0012;
  noise.rotation_step_rad = radians_from_degrees(0.01);
  const TrackerNoiseModel model(1, noise);
  const Rigid<World, Sensor> truth(quaternion_from_euler({0.3, -0.2, 1.1}),
                                   Vector3d(301.23456, 12.34567, -55.5));
  const auto sample = model.reported(truth, 0, 0);
  const auto off_grid = [](double value, double step) {
    return std::abs(value / step - std::round(value / step));
  };
  for (int i = 0; i < 3; ++i) {
    EXPECT_LT(off_grid(sample.translation()[i], 0.0012), 1e-6);
    EXPECT_LE(std::abs(sample.translation()[i] - truth.translation()[i]), 0.0006 + 1e-12);
  }
  const EulerAngles angles = euler_from_quaternion(sample.rotation());
  EXPECT_LT(off_grid(angles.azimuth, noise.rotation_step_rad), 1e-6);
  EXPECT_LT(off_grid(angles.roll, noise.rotation_step_rad), 1e-6);
}

TEST(TwinTracker, WrongHemisphereMirrorsThePosition) {
  TrackerNoise noise;
  noise.hemisphere = {0, 0, 1};
  const TrackerNoiseModel model(1, noise);
  const Rigid<World, Sensor> above({1, 0, 0, 0}, Vector3d(300, 20, -40)),
      below({1, 0, 0, 0}, Vector3d(300, 20, 40));
  EXPECT_EQ(model.reported(above, 0, 0).translation(), Vector3d(-300, -20, 40));
  EXPECT_EQ(model.reported(below, 0, 0).translation(), below.translation());
}

TEST(TwinTracker, ClockDriftsAsRealUnitsDo) {
  TwinOptions options = ideal_twin();
  options.tracker.clock_drift_ppm = 20;  // 240.0048 Hz
  const auto all = samples(options, 3 * 2401);
  EXPECT_NEAR(static_cast<double>(all.back().time - all.front().time), 1e10 / (1 + 20e-6), 1000);
}

double worst_stamp_error(const TwinOptions& options, std::size_t from_sample, double latency) {
  const auto all = samples(options, 9000);
  double worst = 0;
  for (std::size_t i = from_sample; i < all.size(); ++i) {
    const double rate = 240 * (1 + options.tracker.clock_drift_ppm * 1e-6);
    const double exact = all[i].frame_count * 1e9 / rate;
    worst = std::max(worst, std::abs(static_cast<double>(all[i].time) - exact - latency));
  }
  return worst;
}

// Cycles arrive late by 60 us and more; the product's clock fit finds the device's rhythm in them.
TEST(TwinTracker, LateArrivalsAreTakenOutByTheClockFit) {
  TwinOptions options = ideal_twin("condyle", Scenario::demo);
  options.tracker.time_jitter_us = 60;
  options.tracker.clock_drift_ppm = 20;
  EXPECT_LT(worst_stamp_error(options, 3 * 240 * 4, 0), 10e3);
}

TEST(TwinTracker, LatencyIsAnErrorOfTheStampAlone) {
  TwinOptions options = ideal_twin("condyle", Scenario::demo);
  options.tracker.latency = 3 * kMillisecond;
  EXPECT_LT(worst_stamp_error(options, 0, 3e6), 5);
  const auto twin = experiment(options);
  for (const PoseSample& sample : samples(options, 300)) {
    const Nanoseconds exact = std::llround(sample.frame_count * 1e9 / 240);
    EXPECT_LT((sample.world_from_sensor.translation() - truth_of(*twin, sample, exact).translation()).norm(),
              1e-4);
  }
}

TEST(TwinTracker, TimesOfAStationGrow) {
  TwinOptions options = ideal_twin("condyle", Scenario::demo);
  options.tracker.time_jitter_us = 400;
  std::map<int, Nanoseconds> last;
  for (const PoseSample& sample : samples(options, 3000)) {
    if (last.contains(sample.station)) {
      EXPECT_GT(sample.time, last[sample.station]);
    }
    last[sample.station] = sample.time;
  }
}

TEST(TwinTracker, DropOutsComeAsOftenAsAskedAndCarryNoPose) {
  TwinOptions options = ideal_twin();
  options.tracker.dropouts_per_second = 0.5;
  options.tracker.dropout_seconds = 0.2;
  int lost = 0;
  constexpr int kSamples = 3 * 240 * 100;
  for (const PoseSample& sample : samples(options, kSamples)) {
    if (sample.state == ToolState::ok) continue;
    EXPECT_EQ(sample.state, ToolState::out_of_view);
    ++lost;
  }
  // 150 drop-outs are expected, one in twelve more or less by chance.
  EXPECT_NEAR(static_cast<double>(lost) / kSamples, 0.1, 0.03);
}

TEST(TwinTracker, StatusTellsStationsAndEnd) {
  TwinOptions options = ideal_twin();
  options.duration = kSecond / 10;
  TwinTracker tracker(experiment(options));
  PoseSample sample;
  EXPECT_EQ(tracker.next(sample).error().code, ErrorCode::usage) << "not started";
  EXPECT_EQ(tracker.station(0).state, ToolState::never_seen);
  ASSERT_TRUE(tracker.start());
  EXPECT_TRUE(tracker.status().delivering);
  int count = 0;
  while (*tracker.next(sample) == Pull::item) ++count;
  EXPECT_EQ(count, 3 * 24);
  EXPECT_EQ(tracker.next(sample), Pull::end) << "stays at its end";
  EXPECT_FALSE(tracker.status().delivering);
  EXPECT_EQ(tracker.counters().samples, 72u);
  EXPECT_EQ(tracker.station(2).state, ToolState::ok);
  EXPECT_EQ(tracker.station(2).samples, 24u);
  EXPECT_EQ(tracker.station(3).state, ToolState::never_seen);
  EXPECT_THAT(tracker.station(3).reason, testing::HasSubstr("three sensors"));
}

}  // namespace
}  // namespace linescope::twin
