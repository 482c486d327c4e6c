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

  PoseHistory history_;
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
  add(0, at_ms(4), 0);
  EXPECT_FALSE(lookup_.settled(at_ms(2)))
      << "the object's sample is still to come; the harvester never delivered";
  add(1, at_ms(4), 0);
  EXPECT_TRUE(lookup_.settled(at_ms(2)));
}

TEST_F(ToolPosesTest, DoesNotWaitForASensorThatWentSilent) {
  add(0, at_ms(0), 0);
  add(1, at_ms(0), 0);
  add(0, at_ms(10), 0);
  EXPECT_FALSE(lookup_.settled(at_ms(5)));
  add(0, at_ms(70), 0);
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
