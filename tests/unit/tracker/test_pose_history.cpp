#include <gtest/gtest.h>

#include <thread>

#include "acquire/tracker/pose_history.hpp"
#include "common/units.hpp"
#include "samples.hpp"

namespace linescope {
namespace {

using testing::good_sample;
constexpr double kPi = std::numbers::pi;

Eigen::Quaterniond about(const Eigen::Vector3d& axis, double angle) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis.normalized()));
}

TEST(PoseHistory, InterpolatesAlongTheClosedFormOfAConstantTurn) {
  // A body that turns with constant rate about a fixed axis and moves straight: slerp is exact for it.
  const Eigen::Vector3d axis(1, -2, 0.5);
  const auto truth = [&](double s) {
    return Rigid<World, Sensor>(about(axis, 3.0 * s), Eigen::Vector3d(100 * s, -50 * s, 7 + 20 * s));
  };
  PoseHistory history;
  for (int i = 0; i <= 240; ++i) {
    const double s = i / 240.0;
    const auto pose = truth(s);
    history.add(good_sample(1, nanoseconds_from_seconds(s), pose.rotation(), pose.translation()));
  }
  for (const double s : {0.0, 0.0013, 0.25, 0.4999, 0.73219, 1.0}) {
    const PoseAnswer answer = history.pose_at(1, nanoseconds_from_seconds(s));
    ASSERT_TRUE(answer.ok()) << s;
    EXPECT_LT((answer.world_from_sensor.translation() - truth(s).translation()).norm(), 1e-5);  // ns rounding
    EXPECT_LT(answer.world_from_sensor.rotation().angularDistance(truth(s).rotation()), 1e-7);
  }
}

TEST(PoseHistory, TakesTheShortWayWhenTheQuaternionChangesSign) {
  PoseHistory history;
  const Eigen::Quaterniond a = about({0, 0, 1}, 0.1);
  Eigen::Quaterniond b = about({0, 0, 1}, 0.3);
  b.coeffs() *= -1;
  history.add(good_sample(0, 1000, a, {0, 0, 0}));
  history.add(good_sample(0, 2000, b, {0, 0, 0}));
  const PoseAnswer answer = history.pose_at(0, 1500);
  ASSERT_TRUE(answer.ok());
  EXPECT_LT(answer.world_from_sensor.rotation().angularDistance(about({0, 0, 1}, 0.2)), 1e-12);
}

TEST(PoseHistory, CrossesTheAzimuthWrapThroughThePoleNotThroughZero) {
  PoseHistory history;
  history.add(good_sample(0, 1000, about({0, 0, 1}, radians_from_degrees(179)), {0, 0, 0}));
  history.add(good_sample(0, 2000, about({0, 0, 1}, radians_from_degrees(-179)), {0, 0, 0}));
  EXPECT_LT(history.pose_at(0, 1500).world_from_sensor.rotation().angularDistance(about({0, 0, 1}, kPi)),
            1e-12);
}

TEST(PoseHistory, AnExactHitNeedsNoNeighbour) {
  PoseHistory history;
  history.add(good_sample(0, 5000, about({1, 0, 0}, 1), {1, 2, 3}));
  const PoseAnswer answer = history.pose_at(0, 5000);
  ASSERT_TRUE(answer.ok());
  EXPECT_EQ(answer.gap, 0);
  EXPECT_EQ(answer.world_from_sensor.translation(), Eigen::Vector3d(1, 2, 3));
}

TEST(PoseHistory, SaysWhyThereIsNoPose) {
  PoseHistory history({.capacity = 4, .longest_gap = 50 * kMillisecond});
  EXPECT_EQ(history.pose_at(2, 0).miss, PoseMiss::never_seen);
  EXPECT_EQ(history.pose_at(2, 0).state, ToolState::never_seen);
  history.add(good_sample(2, kSecond));
  EXPECT_EQ(history.pose_at(2, kSecond - 1).miss, PoseMiss::too_early);
  EXPECT_EQ(history.pose_at(2, kSecond + 1).miss, PoseMiss::too_late);
  history.add(good_sample(2, kSecond + 50 * kMillisecond));
  EXPECT_TRUE(history.pose_at(2, kSecond + 1).ok());
  history.add(good_sample(2, kSecond + 101 * kMillisecond));
  EXPECT_EQ(history.pose_at(2, kSecond + 60 * kMillisecond).miss, PoseMiss::gap_too_long);
  EXPECT_EQ(history.pose_at(-1, 0).miss, PoseMiss::never_seen);
  EXPECT_EQ(history.pose_at(kMaxStations, 0).miss, PoseMiss::never_seen);
}

TEST(PoseHistory, NeverPlacesBesideABadSample) {
  for (const ToolState bad :
       {ToolState::distorted_field, ToolState::out_of_view, ToolState::missing, ToolState::disconnected}) {
    PoseHistory history;
    history.add(good_sample(0, 10 * kMillisecond));
    PoseSample sample = good_sample(0, 20 * kMillisecond);
    sample.state = bad;
    history.add(sample);
    history.add(good_sample(0, 30 * kMillisecond));
    for (const Nanoseconds t : {15, 20, 25}) {
      const PoseAnswer answer = history.pose_at(0, t * kMillisecond);
      EXPECT_EQ(answer.miss, PoseMiss::state_bad);
      EXPECT_EQ(answer.state, bad);
    }
    EXPECT_TRUE(history.pose_at(0, 30 * kMillisecond).ok());
  }
}

TEST(PoseHistory, KeepsTheNewestSamplesOnly) {
  PoseHistory history({.capacity = 10, .longest_gap = kSecond});
  for (int i = 0; i < 25; ++i) history.add(good_sample(0, 1000 * i));
  EXPECT_EQ(history.pose_at(0, 14'999).miss, PoseMiss::too_early);
  EXPECT_TRUE(history.pose_at(0, 15'000).ok());
  EXPECT_TRUE(history.pose_at(0, 24'000).ok());
  PoseSample newest;
  ASSERT_TRUE(history.latest(0, newest));
  EXPECT_EQ(newest.time, 24'000);
  EXPECT_FALSE(history.latest(1, newest));
}

TEST(PoseHistory, RefusesSamplesThatAreNotNewer) {
  PoseHistory history;
  EXPECT_TRUE(history.add(good_sample(0, 2000)));
  EXPECT_FALSE(history.add(good_sample(0, 2000)));
  EXPECT_FALSE(history.add(good_sample(0, 1999)));
  EXPECT_FALSE(history.add(good_sample(kMaxStations, 3000)));
  EXPECT_TRUE(history.add(good_sample(1, 1000)));
  EXPECT_EQ(history.rejected(), 3u);
}

TEST(PoseHistory, MeanOverTheExposureLowersTheNoise) {
  // Alternating +-1 mm and +-1 degree about a fixed pose: the mean of an even number of samples is that pose.
  PoseHistory history;
  for (int i = 0; i < 20; ++i) {
    const double sign = i % 2 == 0 ? 1 : -1;
    history.add(good_sample(0, i * 4 * kMillisecond, about({0, 1, 0}, 0.5 + sign * radians_from_degrees(1)),
                            {10 + sign, 0, 0}));
  }
  const PoseAnswer mean =
      history.mean_pose(0, 7 * kMillisecond, 41 * kMillisecond);  // samples at 8 .. 40: nine
  ASSERT_TRUE(mean.ok());
  EXPECT_NEAR(mean.world_from_sensor.translation().x(), 10 + 1.0 / 9, 1e-12);
  EXPECT_NEAR(mean.world_from_sensor.rotation().angularDistance(about({0, 1, 0}, 0.5)),
              radians_from_degrees(1.0 / 9), 1e-5);
  EXPECT_EQ(history.mean_pose(0, 70 * kMillisecond, 90 * kMillisecond).miss, PoseMiss::too_late);
  // Shorter than a cycle: the pose in the middle.
  const PoseAnswer narrow = history.mean_pose(0, 9 * kMillisecond, 11 * kMillisecond);
  ASSERT_TRUE(narrow.ok());
  EXPECT_NEAR(narrow.world_from_sensor.translation().x(), 10 + 0.5 - 0.5, 1e-12);
}

TEST(PoseHistory, MeanRefusesABadSampleInside) {
  PoseHistory history;
  for (int i = 0; i < 5; ++i) {
    PoseSample sample = good_sample(0, i * 4 * kMillisecond);
    if (i == 2) sample.state = ToolState::distorted_field;
    history.add(sample);
  }
  EXPECT_EQ(history.mean_pose(0, 1 * kMillisecond, 15 * kMillisecond).miss, PoseMiss::state_bad);
}

TEST(PoseHistory, AReaderNeverSeesHalfASample) {
  // Position x, y, z and time carry the same number in every sample: a torn read would show two different
  // ones.
  PoseHistory history({.capacity = 4, .longest_gap = kSecond});
  constexpr int kSamples = 200'000;
  std::thread producer([&] {
    for (int i = 1; i <= kSamples; ++i)
      history.add(good_sample(0, i, Eigen::Quaterniond::Identity(), {1.0 * i, 2.0 * i, 3.0 * i}));
  });
  int torn = 0;
  int seen = 0;
  PoseSample sample;
  do {
    if (!history.latest(0, sample)) continue;
    const auto x = static_cast<double>(sample.time);
    ++seen;
    if (sample.world_from_sensor.translation() != Eigen::Vector3d(x, 2 * x, 3 * x)) ++torn;
    const PoseAnswer answer = history.pose_at(0, sample.time);
    if (answer.ok() && answer.world_from_sensor.translation() != Eigen::Vector3d(x, 2 * x, 3 * x)) ++torn;
  } while (sample.time < kSamples);
  producer.join();
  EXPECT_EQ(torn, 0);
  EXPECT_GT(seen, 0);
}

TEST(PoseHistory, OptionsAreChecked) {
  EXPECT_TRUE(validate(PoseHistoryOptions{}));
  EXPECT_EQ(validate({.capacity = 1, .longest_gap = 1}).error().code, ErrorCode::invalid);
  EXPECT_EQ(validate({.capacity = 2, .longest_gap = 0}).error().code, ErrorCode::invalid);
}

TEST(PoseHistory, EveryReasonHasWords) {
  for (int i = 0; i <= static_cast<int>(PoseMiss::state_bad); ++i)
    EXPECT_NE(name(static_cast<PoseMiss>(i)), "unknown");
}

}  // namespace
}  // namespace linescope
