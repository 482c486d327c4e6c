#include <gtest/gtest.h>

#include "acquire/tool_poses.hpp"

namespace linescope {
namespace {

class ToolPosesTest : public ::testing::Test {
 protected:
  void add(int station, Nanoseconds time, double x, ToolState state = ToolState::ok) {
    PoseSample s;
    s.time = time;
    s.station = static_cast<std::uint8_t>(station);
    s.state = state;
    s.world_from_sensor = {Eigen::Quaterniond::Identity(), {x, 0, 0}};
    ASSERT_TRUE(history_.add(s));
  }

  PoseHistory history_{{.mean_over = 25 * kMillisecond}};
  ToolPoseLookup lookup_{history_, StationRoles{}, 60 * kMillisecond};
};

constexpr Nanoseconds at_ms(int ms) {
  return kSecond + ms * kMillisecond;
}

TEST_F(ToolPosesTest, EachToolGetsThePoseOfItsStation) {
  for (int station = 0; station < 3; ++station) {
    add(station, at_ms(0), station * 10.0);
    add(station, at_ms(4), station * 10.0 + 4);
  }
  const ToolPoses poses = lookup_.at(at_ms(1));
  EXPECT_NEAR(poses.endoscope.world_from_tool.translation().x(), 1, 1e-12);
  EXPECT_NEAR(poses.object.world_from_tool.translation().x(), 11, 1e-12);
  EXPECT_NEAR(poses.harvester.world_from_tool.translation().x(), 21, 1e-12);
  EXPECT_EQ(poses.object.state, ToolState::ok);
}

TEST_F(ToolPosesTest, WaitsForEveryToolThatDelivers) {
  add(0, at_ms(0), 0);
  add(1, at_ms(0), 0);
  EXPECT_FALSE(lookup_.settled(at_ms(2)));
  add(0, at_ms(15), 0);
  EXPECT_FALSE(lookup_.settled(at_ms(2)))
      << "the object's sample is still to come; the harvester never delivered";
  add(1, at_ms(14), 0);
  EXPECT_FALSE(lookup_.settled(at_ms(2))) << "the mean reaches 12.5 ms ahead";
  add(1, at_ms(15), 0);
  EXPECT_TRUE(lookup_.settled(at_ms(2)));
}

TEST_F(ToolPosesTest, AHandThatMovesStraightOnIsWhereItWasAtTheInstant) {
  for (int ms = 0; ms <= 40; ms += 4) add(0, at_ms(ms), 0.5 * ms);
  EXPECT_NEAR(lookup_.at(at_ms(19)).endoscope.world_from_tool.translation().x(), 9.5, 1e-9);
}

TEST_F(ToolPosesTest, OneWildSampleCountsASeventh) {
  for (int ms = 0; ms <= 40; ms += 4) add(0, at_ms(ms), ms == 20 ? 7 : 0);
  PoseHistory plain({.mean_over = 0});
  PoseSample sample;
  for (std::uint64_t i = 0; i <= 10; ++i) {
    sample.time = at_ms(static_cast<int>(4 * i));
    sample.state = ToolState::ok;
    sample.world_from_sensor = {Eigen::Quaterniond::Identity(), {i == 5 ? 7.0 : 0.0, 0, 0}};
    ASSERT_TRUE(plain.add(sample));
  }
  const ToolPoseLookup alone(plain, StationRoles{}, 60 * kMillisecond);
  EXPECT_NEAR(alone.at(at_ms(20)).endoscope.world_from_tool.translation().x(), 7, 1e-9);
  // Samples are 4 ms apart, instants 4.17 ms: the neighbours do not touch the wild sample.
  EXPECT_NEAR(lookup_.at(at_ms(20)).endoscope.world_from_tool.translation().x(), 1, 1e-9);
}

TEST(PoseMeanOptions, AMeanOverMoreThanAGapIsRefused) {
  EXPECT_TRUE(validate(PoseHistoryOptions{.mean_over = 0}).has_value());
  EXPECT_FALSE(validate(PoseHistoryOptions{.mean_over = -1}).has_value());
  EXPECT_FALSE(validate(PoseHistoryOptions{.mean_over = kSecond}).has_value());
}

TEST_F(ToolPosesTest, AtTheEndOfTheHistoryTheMeanIsTakenOverWhatIsThere) {
  for (int ms = 0; ms <= 20; ms += 4) add(0, at_ms(ms), ms);
  const auto pose = lookup_.at(at_ms(18)).endoscope;
  EXPECT_EQ(pose.state, ToolState::ok);
  EXPECT_NEAR(pose.world_from_tool.translation().x(), 18, 1e-9);
}

TEST_F(ToolPosesTest, DoesNotWaitForASensorThatWentSilent) {
  add(0, at_ms(0), 0);
  add(1, at_ms(0), 0);
  add(0, at_ms(20), 0);
  EXPECT_FALSE(lookup_.settled(at_ms(5)));
  add(0, at_ms(90), 0);
  EXPECT_TRUE(lookup_.settled(at_ms(5)));
}

TEST_F(ToolPosesTest, ABadSampleOnOneSideIsTheStateOfTheTool) {
  add(0, at_ms(0), 0);
  add(0, at_ms(4), 0, ToolState::distorted_field);
  EXPECT_EQ(lookup_.at(at_ms(2)).endoscope.state, ToolState::distorted_field);
  EXPECT_EQ(lookup_.at(at_ms(2)).harvester.state, ToolState::never_seen);
}

TEST_F(ToolPosesTest, AnOldPoseIsStaleNotOk) {
  add(0, at_ms(0), 0);
  EXPECT_EQ(lookup_.at(at_ms(100)).endoscope.state, ToolState::stale);
}

}  // namespace
}  // namespace linescope
