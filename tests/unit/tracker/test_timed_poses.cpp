#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acquire/tracker/csv_reader.hpp"
#include "acquire/tracker/timed_pose_source.hpp"
#include "samples.hpp"

namespace linescope {
namespace {

using ::testing::HasSubstr;
using testing::read_all;
using testing::TextFile;
using testing::Told;

const std::string kHeader = "time_s,station,x_mm,y_mm,z_mm,qw,qx,qy,qz\n";

TEST(DecimalSeconds, KeepEveryNanosecondOfAUnixTime) {
  EXPECT_EQ(nanoseconds_from_decimal_seconds("1686230466.069739612"), 1686230466069739612);
  EXPECT_EQ(nanoseconds_from_decimal_seconds("0.1"), 100'000'000);
  EXPECT_EQ(nanoseconds_from_decimal_seconds("-1.5"), -1'500'000'000);
  EXPECT_EQ(nanoseconds_from_decimal_seconds("+7"), 7'000'000'000);
  EXPECT_EQ(nanoseconds_from_decimal_seconds("1e-3"), 1'000'000);
  for (const char* bad : {"", "nan", "inf", "1.2.3", "12a", "1e30"})
    EXPECT_FALSE(nanoseconds_from_decimal_seconds(bad)) << bad;
}

TEST(TimedPoses, StationsCountFromOneInTheFile) {
  const TextFile file(
      "t.csv", kHeader + "0.5,1,1,2,3,1,0,0,0\r\n# remark\n\n0.5,2,4,5,6,1,0,0,0\n0.6,1,1,2,3,1,0,0,0\n");
  TimedPoseSource source(file.path(), {});
  ASSERT_TRUE(source.start());
  const Told told = read_all(source);
  EXPECT_TRUE(told.errors.empty());
  ASSERT_EQ(told.samples.size(), 3u);
  EXPECT_EQ(told.samples[1].station, 1);
  EXPECT_EQ(told.samples[1].time, 500 * kMillisecond);
  EXPECT_EQ(told.samples[2].time, 600 * kMillisecond);
}

TEST(TimedPoses, TimesCanBeMovedToTheCallersClock) {
  const TextFile file("t.csv", kHeader + "1686230466.25,1,1,2,3,1,0,0,0\n1686230466.5,1,1,2,3,1,0,0,0\n");
  TimedPoseSource source(file.path(), {.first_row_at = 7 * kSecond, .mm_per_unit = 10});
  ASSERT_TRUE(source.start());
  const Told told = read_all(source);
  ASSERT_EQ(told.samples.size(), 2u);
  EXPECT_EQ(told.samples[0].time, 7 * kSecond);
  EXPECT_EQ(told.samples[1].time, 7 * kSecond + 250 * kMillisecond);
}

TEST(TimedPoses, OptionalColumnsAreRead) {
  const TextFile file("t.csv",
                      "time_s,station,x_mm,y_mm,z_mm,qw,qx,qy,qz,state,frame_count,distortion,arrival_s\n"
                      "1,1,1,2,3,1,0,0,0,ok,4294967295,2,1.25\n"
                      "2,1,nan,nan,nan,nan,nan,nan,nan,out of view,7,nan,2.25\n");
  TimedPoseSource source(file.path(), {});
  ASSERT_TRUE(source.start());
  const Told told = read_all(source);
  ASSERT_EQ(told.samples.size(), 2u);
  EXPECT_EQ(told.samples[0].frame_count, 4294967295u);
  EXPECT_EQ(told.samples[0].distortion, 2.0F);
  EXPECT_EQ(told.samples[0].arrival, 1'250'000'000);
  EXPECT_EQ(told.samples[1].state, ToolState::out_of_view);
  EXPECT_TRUE(std::isnan(told.samples[1].distortion));
  EXPECT_EQ(source.station(0).state, ToolState::out_of_view);
  EXPECT_EQ(source.station(0).reason, "out of view");
}

TEST(TimedPoses, ABadRowIsLeftOutAndReported) {
  const TextFile file(
      "t.csv", kHeader + "1,1,1,2,3,1,0,0,0\n2,1,nan,2,3,1,0,0,0\n3,9,1,2,3,1,0,0,0\n4,1,1,2,3,1,0,0,0\n");
  TimedPoseSource source(file.path(), {});
  ASSERT_TRUE(source.start());
  const Told told = read_all(source);
  ASSERT_EQ(told.samples.size(), 2u);
  EXPECT_EQ(told.samples[1].time, 4 * kSecond);
  ASSERT_EQ(told.errors.size(), 2u);
  EXPECT_EQ(told.errors[0].code, ErrorCode::unreadable);
  EXPECT_THAT(told.errors[0].message, HasSubstr("t.csv:3: x_mm is \"nan\", a finite number is expected"));
  EXPECT_THAT(told.errors[1].message,
              HasSubstr("t.csv:4: station is \"9\", a whole number from 1 to 8 is expected"));
  EXPECT_EQ(source.counters().bad_records, 2u);
}

TEST(TimedPoses, ARowOutOfOrderEndsTheSourceAndKeepsWhatCameBefore) {
  const TextFile file(
      "t.csv", kHeader + "1,1,1,2,3,1,0,0,0\n2,1,1,2,3,1,0,0,0\n1.5,1,1,2,3,1,0,0,0\n3,1,1,2,3,1,0,0,0\n");
  TimedPoseSource source(file.path(), {});
  ASSERT_TRUE(source.start());
  const Told told = read_all(source);
  EXPECT_EQ(told.samples.size(), 2u);
  ASSERT_EQ(told.errors.size(), 1u);
  EXPECT_EQ(told.errors[0].code, ErrorCode::invalid);
  EXPECT_THAT(told.errors[0].message, HasSubstr("t.csv:4: the row's time is earlier than the row before"));
  EXPECT_EQ(source.counters().out_of_order, 1u);
  EXPECT_FALSE(source.status().delivering);
}

TEST(TimedPoses, TheSameTimeTwiceForOneStationIsOutOfOrder) {
  const TextFile file("t.csv", kHeader + "1,1,1,2,3,1,0,0,0\n1,2,1,2,3,1,0,0,0\n1,1,1,2,3,1,0,0,0\n");
  TimedPoseSource source(file.path(), {});
  ASSERT_TRUE(source.start());
  const Told told = read_all(source);
  EXPECT_EQ(told.samples.size(), 2u);
  ASSERT_EQ(told.errors.size(), 1u);
  EXPECT_THAT(told.errors[0].message, HasSubstr("station 1's last row"));
}

TEST(TimedPoses, TheHeaderIsChecked) {
  const TextFile file("t.csv", "time_s,x_mm,y_mm,z_mm,qw,qx,qy,qz\n");
  const auto start = TimedPoseSource(file.path(), {}).start();
  ASSERT_FALSE(start);
  EXPECT_EQ(start.error().code, ErrorCode::invalid);
  EXPECT_THAT(start.error().message, HasSubstr("t.csv:1: column station is missing"));
  EXPECT_EQ(TimedPoseSource("/nowhere.csv", {}).start().error().code, ErrorCode::not_found);
  EXPECT_EQ(TimedPoseSource(file.path(), {.first_row_at = {}, .mm_per_unit = 0}).start().error().code,
            ErrorCode::usage);
}

}  // namespace
}  // namespace linescope
