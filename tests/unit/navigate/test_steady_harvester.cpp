// The harvester's steady tip and axis: noise out, movement in.
#include <gtest/gtest.h>

#include <random>

#include "common/units.hpp"
#include "viewer/navigate/angle_difference.hpp"
#include "viewer/navigate/display_latency.hpp"
#include "viewer/navigate/steady_harvester.hpp"

namespace linescope {
namespace {

using Eigen::Vector3d;

constexpr Nanoseconds kPeriod = kSecond / 240;

TEST(SteadyHarvester, AStillHandIsStillAndWhereItIs) {
  SteadyHarvester steady;
  std::mt19937 random(1);
  std::normal_distribution<double> noise;
  const Vector3d tip(10, -20, 30);
  double squares = 0, tilt = 0;
  int n = 0;
  for (int i = 0; i < 2400; ++i) {
    const Vector3d shaken = tip + 0.5 * Vector3d(noise(random), noise(random), noise(random));
    const Vector3d axis(0.0025 * noise(random), 0.0025 * noise(random), 1);
    const auto& hold = steady.follow(shaken, axis, i * kPeriod);
    if (i < 240) continue;  // a second to settle
    squares += (hold.tip - tip).squaredNorm() / 3;
    tilt += angle_difference(hold.axis, {0, 0, 1});
    ++n;
  }
  EXPECT_LT(std::sqrt(squares / n), 0.5 / 4);  // a quarter of a sample's noise
  EXPECT_LT(tilt / n, 0.0025 * 1.25 / 5);
}

TEST(SteadyHarvester, AMovingHandIsHardlyLate) {
  SteadyHarvester steady;
  double behind = 0, late = 0;
  for (int i = 0; i < 480; ++i) {
    const double t = i / 240.0;
    const Vector3d tip(20 * t, 0, 0);  // 20 mm/s
    const Vector3d axis(std::sin(0.2 * t), 0, std::cos(0.2 * t));
    const auto& hold = steady.follow(tip, axis, i * kPeriod);
    behind = (tip - hold.tip).norm();
    late = angle_difference(axis, hold.axis);
  }
  EXPECT_LT(behind, 0.35);                     // 17 ms of way
  EXPECT_LT(late, radians_from_degrees(0.3));  // of 11.5 degrees a second
}

TEST(SteadyHarvester, BeginsAnewAfterAPauseAndAfterALoss) {
  SteadyHarvester steady;
  steady.follow({0, 0, 0}, {0, 0, 1}, 0);
  EXPECT_LT(steady.follow({5, 0, 0}, {0, 0, 1}, kPeriod).tip.x(), 4.0);
  EXPECT_EQ(steady.follow({9, 0, 0}, {0, 0, 1}, kSecond).tip.x(), 9.0);
  steady.reset();
  EXPECT_EQ(steady.follow({1, 0, 0}, {0, 0, 2}, kSecond + kPeriod).tip.x(), 1.0);
  EXPECT_EQ(steady.follow({1, 0, 0}, {0, 0, 2}, kSecond + 2 * kPeriod).axis.z(), 1.0);
}

TEST(SteadyHarvester, TheSameTimeAgainIsTheSameAnswerAndABadSampleDoesNotStay) {
  SteadyHarvester steady;
  steady.follow({0, 0, 0}, {0, 0, 1}, 0);
  const Vector3d first = steady.follow({1, 0, 0}, {0, 0, 1}, kPeriod).tip;
  EXPECT_EQ(steady.follow({1, 0, 0}, {0, 0, 1}, kPeriod).tip, first);
  EXPECT_FALSE(steady.follow({std::nan(""), 0, 0}, {0, 0, 1}, 2 * kPeriod).tip.allFinite());
  EXPECT_EQ(steady.follow({3, 0, 0}, {0, 0, 1}, 3 * kPeriod).tip.x(), 3.0);
}

TEST(SteadyHarvester, RefusesImpossibleOptions) {
  EXPECT_TRUE(validate(SteadyHarvesterOptions{}).has_value());
  EXPECT_FALSE(validate(SteadyHarvesterOptions{.slowest_hz = 0}).has_value());
  EXPECT_FALSE(validate(SteadyHarvesterOptions{.tip_hz_per_speed = -1}).has_value());
  EXPECT_FALSE(validate(SteadyHarvesterOptions{.longest_pause = 0}).has_value());
}

TEST(DisplayLatency, CountsASampleWhenItIsFirstShown) {
  DisplayLatency latency;
  EXPECT_EQ(latency.summary().count, 0u);
  for (int i = 1; i <= 100; ++i) {
    latency.shown(i * kSecond, i * kSecond + i * kMillisecond);
    latency.shown(i * kSecond, i * kSecond + kSecond / 2);  // still on the screen
  }
  latency.shown(200 * kSecond, 199 * kSecond);  // from the future
  const LatencySummary s = latency.summary();
  EXPECT_EQ(s.count, 100u);
  EXPECT_EQ(s.p50, 51 * kMillisecond);
  EXPECT_EQ(s.p95, 95 * kMillisecond);
  EXPECT_EQ(s.max, 100 * kMillisecond);
}

TEST(DisplayLatency, ForgetsWhatIsLongAgo) {
  DisplayLatency latency;
  latency.shown(kSecond, 10 * kSecond);
  for (int i = 0; i < static_cast<int>(DisplayLatency::kKept); ++i)
    latency.shown((20 + i) * kSecond, (20 + i) * kSecond + kMillisecond);
  EXPECT_EQ(latency.summary().max, kMillisecond);
  EXPECT_EQ(latency.summary().count, DisplayLatency::kKept + 1);
}

}  // namespace
}  // namespace linescope
