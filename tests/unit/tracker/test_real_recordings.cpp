#include <gtest/gtest.h>

#include "acquire/tracker/picture_pose_source.hpp"
#include "acquire/tracker/timed_pose_source.hpp"
#include "samples.hpp"
#include "tests/support/shared_data.hpp"

namespace linescope {
namespace {

using testing::read_all;
using testing::Told;

TEST(RealRecordings, TheMiniatureScannersFile) {
  LINESCOPE_NEEDS_SHARED_DATA();
  std::vector<PictureInstant> pictures;
  for (const int i : {0, 7, 24, 99}) pictures.push_back({"im" + std::to_string(i) + ".png", 1000 * i + 1});
  PicturePoseSource source(testing::shared_data("miniature-scanner/poses.csv"), pictures, {});
  ASSERT_TRUE(source.start());
  const Told told = read_all(source);
  ASSERT_EQ(told.samples.size(), 4u);
  EXPECT_TRUE(told.errors.empty());
  EXPECT_DOUBLE_EQ(told.samples[2].world_from_sensor.translation().z(), 297.688853457);
  EXPECT_NEAR(told.samples[1].world_from_sensor.rotation().w(), 0.80391577035795647, 1e-12);
  EXPECT_EQ(told.samples[3].state, ToolState::missing);
}

TEST(RealRecordings, ARealTwoSensorRecordingGivesOneSamplePerChange) {
  LINESCOPE_NEEDS_SHARED_DATA();
  TimedPoseSource source(testing::shared_data("tracker/liberty-two-sensors-a.csv"), {});
  ASSERT_TRUE(source.start());
  const Told told = read_all(source);
  EXPECT_TRUE(told.errors.empty()) << told.errors.front().message;
  const auto first = source.station(0);
  const auto second = source.station(1);
  const double seconds = seconds_from(told.samples.back().time - told.samples.front().time);
  // 120.0 to 120.3 new samples per second and sensor is what is known of these recordings.
  EXPECT_NEAR(static_cast<double>(first.samples) / seconds, 120.15, 0.4);
  EXPECT_NEAR(static_cast<double>(second.samples) / seconds, 120.15, 0.4);
  EXPECT_NEAR(told.samples.front().world_from_sensor.translation().x(), 7.287830710411072, 1e-12);
}

}  // namespace
}  // namespace linescope
