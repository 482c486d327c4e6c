// The steps around the fits: keys, either order of pivot and spin, sensors that are hidden or held by another
// one, what is stored and what is given back as previous.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/calibrate/tool_motion.hpp"
#include "tools/calibrate/check_step.hpp"
#include "tools/calibrate/harvester_step.hpp"
#include "tools/calibrate/time_step.hpp"

namespace linescope::calibrate {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

PoseSample sample_of(const TimedToolPose& pose, int station) {
  PoseSample sample;
  sample.time = pose.time;
  sample.station = static_cast<std::uint8_t>(station);
  sample.state = ToolState::ok;
  sample.world_from_sensor = renamed<World, Sensor>(pose.fixture_from_tool);
  return sample;
}

Session session_of(const ToolPoses& poses) {
  Session session;
  for (const TimedToolPose& pose : poses) session.poses[2].push_back(sample_of(pose, 2));
  return session;
}

Result<Outcome> run(ToolMotion motion, const Session& session, const Calibration& before,
                    HeldBy held_by = HeldBy::world) {
  HarvesterStep step;
  step.options().motion = motion;
  step.options().held_by = held_by;
  return step.run(session, {}, before);
}

const PoseErrors kQuiet{0.02, 0.0002, 11};

void put(ToolMotion motion, const ToolPoses& poses, Calibration& calibration) {
  const auto outcome = run(motion, session_of(poses), calibration);
  ASSERT_TRUE(outcome) << outcome.error().message;
  ASSERT_FALSE(outcome->refused);
  outcome->put(calibration);
}

TEST(HarvesterStep, PivotAndSpinInEitherOrderGiveTheSame) {
  const ToolTruth truth;
  Calibration first, second;
  // The axis of a fresh calibration points the wrong way on purpose: nobody knows yet where the tip is.
  first.harvester.axis = second.harvester.axis = -truth.axis;
  put(ToolMotion::pivot, pivoting(600, kQuiet), first);
  put(ToolMotion::spin, spinning(600, kQuiet), first);
  put(ToolMotion::spin, spinning(600, kQuiet), second);
  put(ToolMotion::pivot, pivoting(600, kQuiet), second);
  for (const Calibration* calibration : {&first, &second}) {
    EXPECT_LT((calibration->harvester.tip - truth.tip).norm(), 0.05);
    EXPECT_GT(calibration->harvester.axis.dot(truth.axis), 0.9999);
  }
}

TEST(HarvesterStep, SpinTellsHowFarTheKnownTipLiesBesideTheAxis) {
  Calibration calibration;
  calibration.harvester.tip = ToolTruth{}.tip + 3 * ToolTruth{}.axis.unitOrthogonal();
  const auto outcome = run(ToolMotion::spin, session_of(spinning(600, kQuiet)), calibration);
  ASSERT_TRUE(outcome);
  EXPECT_THAT(outcome->quality.spread.back().name, HasSubstr("lies beside this axis"));
  EXPECT_NEAR(outcome->quality.spread.back().value, 3, 0.05);
}

TEST(HarvesterStep, PreviousValueIsGivenBack) {
  Calibration calibration;
  calibration.harvester.tip = {1, 2, 3};
  const auto outcome = run(ToolMotion::pivot, session_of(pivoting(600, kQuiet)), calibration);
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->put(calibration), "tip 1.0000 2.0000 3.0000");
}

TEST(HarvesterStep, AHiddenSensorIsRefusedAndNamed) {
  Session session = session_of(pivoting(600, kQuiet));
  for (std::size_t i = 30; i < 600; ++i) session.poses[2][i].state = ToolState::out_of_view;
  const auto outcome = run(ToolMotion::pivot, session, {});
  ASSERT_FALSE(outcome);
  EXPECT_EQ(outcome.error().code, ErrorCode::too_few);
  EXPECT_THAT(outcome.error().message, HasSubstr("30 good poses"));
  const HeldPoses held = held_poses(session, HeldBy::world);
  ASSERT_EQ(held.left_out.size(), 1u);
  EXPECT_THAT(held.left_out[0].name, HasSubstr("570 samples"));
}

TEST(HarvesterStep, ADivotOnTheObjectMayMove) {
  Session session;
  for (const TimedToolPose& pose : pivoting(600, kQuiet)) {
    const double way = seconds_from(pose.time);
    const Rigid<Fixture, Fixture> moved(Eigen::Quaterniond(Eigen::AngleAxisd(0.1 * way, Vector3d::UnitZ())),
                                        Vector3d(5 * way, -3 * way, 0));
    session.poses[2].push_back(sample_of({pose.time, moved * pose.fixture_from_tool}, 2));
    session.poses[1].push_back(sample_of({pose.time, renamed<Fixture, Harvester>(moved)}, 1));
  }
  Calibration calibration;
  const auto outcome = run(ToolMotion::pivot, session, calibration, HeldBy::object);
  ASSERT_TRUE(outcome) << outcome.error().message;
  ASSERT_FALSE(outcome->refused);
  outcome->put(calibration);
  EXPECT_LT((calibration.harvester.tip - ToolTruth{}.tip).norm(), 0.05);
  // Taken as resting, the same motion is far above the limit.
  const auto resting = run(ToolMotion::pivot, session, {});
  EXPECT_TRUE(!resting || resting->refused);
}

TEST(HarvesterStep, ResidualIsNotTheHeldOutError) {
  const auto outcome = run(ToolMotion::pivot, session_of(pivoting(600, kQuiet)), {});
  ASSERT_TRUE(outcome);
  EXPECT_NE(outcome->quality.residual, outcome->quality.held_out);
  EXPECT_EQ(outcome->quality.used + (outcome->quality.left_out.empty() ? 0 : 1), outcome->quality.offered);
}

TEST(CheckStep, ABodyWithoutALineIsRefused) {
  Session session = session_of(pivoting(600, kQuiet));
  session.width = 360;
  session.height = 240;
  const auto outcome = CheckStep().run(session, {}, thesis_camera_ii());
  ASSERT_FALSE(outcome);
  EXPECT_EQ(outcome.error().code, ErrorCode::too_few);
}

TEST(Steps, KeysAreDeclaredWithoutMistakeAndDefaultsAreValid) {
  HarvesterStep harvester;
  TimeStep time;
  CheckStep check;
  for (Step* step : {static_cast<Step*>(&harvester), static_cast<Step*>(&time), static_cast<Step*>(&check)}) {
    ConfigSchema schema;
    step->declare(schema);
    EXPECT_TRUE(schema.check().empty()) << step->name() << ": " << schema.check().front().message;
    EXPECT_TRUE(step->validate());
  }
}

}  // namespace
}  // namespace linescope::calibrate
