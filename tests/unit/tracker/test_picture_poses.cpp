#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acquire/tracker/picture_pose_source.hpp"
#include "samples.hpp"

namespace linescope {
namespace {

using ::testing::HasSubstr;
using testing::read_all;
using testing::TextFile;
using testing::Told;

const std::string kHeader = "frame,x_mm,y_mm,z_mm,qw,qx,qy,qz\n";
const std::string kGoodA = "a.png,1,2,3,1,0,0,0\n";
const std::string kGoodB = "b.png,4,5,6,0,1,0,0\n";

std::vector<PictureInstant> three_pictures() {
  return {{"a.png", 100}, {"folder/b.png", 200}, {"c.png", 300}};
}

Result<void> started(const std::string& content) {
  const TextFile file("poses.csv", content);
  return PicturePoseSource(file.path(), three_pictures(), {}).start();
}

TEST(PicturePoses, RowsGetTheTimesOfTheirPictures) {
  const TextFile file("poses.csv", kHeader + kGoodB + "c.png,7,8,9,0,0,1,0\n" + kGoodA);
  PicturePoseSource source(file.path(), three_pictures(), {.station = 2});
  ASSERT_TRUE(source.start());
  EXPECT_FALSE(source.live());
  const Told told = read_all(source);
  EXPECT_TRUE(told.errors.empty());
  ASSERT_EQ(told.samples.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(told.samples[i].time, static_cast<Nanoseconds>(100 * (i + 1)));
    EXPECT_EQ(told.samples[i].station, 2);
    EXPECT_EQ(told.samples[i].state, ToolState::ok);
  }
  EXPECT_EQ(told.samples[1].world_from_sensor.translation(), Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(source.station(2).samples, 3u);
}

TEST(PicturePoses, APictureWithoutARowIsMissingAndCounted) {
  const TextFile file("poses.csv", kHeader + kGoodA + "c.png,7,8,9,0,0,1,0\n");
  PicturePoseSource source(file.path(), three_pictures(), {});
  ASSERT_TRUE(source.start());
  const Told told = read_all(source);
  ASSERT_EQ(told.samples.size(), 3u);
  EXPECT_EQ(told.samples[1].state, ToolState::missing);
  EXPECT_EQ(told.samples[1].time, 200);
  EXPECT_EQ(source.counters().missing_poses, 1u);
  EXPECT_THAT(source.status().sentence, HasSubstr("1 pictures without a pose"));
}

TEST(PicturePoses, AColumnOfStationsSplitsTheRows) {
  const TextFile file(
      "poses.csv",
      "station,frame,x_mm,y_mm,z_mm,qw,qx,qy,qz\n1,a.png,1,0,0,1,0,0,0\n3,a.png,2,0,0,1,0,0,0\n");
  PicturePoseSource source(file.path(), {{"a.png", 5}}, {});
  ASSERT_TRUE(source.start());
  const Told told = read_all(source);
  ASSERT_EQ(told.samples.size(), 2u);
  EXPECT_EQ(told.samples[0].station, 0);
  EXPECT_EQ(told.samples[1].station, 2);
}

TEST(PicturePoses, MissingFile) {
  const auto start = PicturePoseSource("/nowhere/poses.csv", three_pictures(), {}).start();
  ASSERT_FALSE(start);
  EXPECT_EQ(start.error().code, ErrorCode::not_found);
  EXPECT_EQ(start.error().message, "/nowhere/poses.csv: there is no such pose file");
}

TEST(PicturePoses, MissingColumnIsNamed) {
  const auto start = started("frame,x_mm,y_mm,z_mm,qw,qx,qy\n" + kGoodA);
  ASSERT_FALSE(start);
  EXPECT_EQ(start.error().code, ErrorCode::invalid);
  EXPECT_THAT(start.error().message, HasSubstr("poses.csv:1: column qz is missing"));
}

TEST(PicturePoses, EmptyFileAndFileWithoutRows) {
  EXPECT_THAT(started("").error().message, HasSubstr("is empty"));
  EXPECT_THAT(started(kHeader).error().message, HasSubstr("has a header but no pose"));
}

TEST(PicturePoses, TwoRowsForOnePictureAreRefused) {
  const auto start = started(kHeader + kGoodA + kGoodB + kGoodA);
  ASSERT_FALSE(start);
  EXPECT_EQ(start.error().code, ErrorCode::invalid);
  EXPECT_THAT(start.error().message, HasSubstr("poses.csv:4: a.png has a pose already, in line 2"));
}

struct BadRow {
  const char* row;
  const char* sentence;
};

class PicturePosesBadRow : public ::testing::TestWithParam<BadRow> {};

TEST_P(PicturePosesBadRow, ConcernsItsPictureOnly) {
  const TextFile file("poses.csv", kHeader + kGoodA + GetParam().row + "\nc.png,7,8,9,0,0,1,0\n");
  PicturePoseSource source(file.path(), three_pictures(), {});
  ASSERT_TRUE(source.start());
  const Told told = read_all(source);
  ASSERT_EQ(told.errors.size(), 1u);
  EXPECT_EQ(told.errors[0].code, ErrorCode::unreadable);
  EXPECT_THAT(told.errors[0].message, HasSubstr(GetParam().sentence));
  EXPECT_THAT(told.errors[0].message, HasSubstr("poses.csv:3: "));
  ASSERT_EQ(told.samples.size(), 3u);
  EXPECT_EQ(told.samples[0].state, ToolState::ok);
  EXPECT_EQ(told.samples[1].state, ToolState::missing);
  EXPECT_EQ(told.samples[2].state, ToolState::ok);
  EXPECT_EQ(source.counters().bad_records, 1u);
  EXPECT_EQ(source.counters().missing_poses, 1u);
}

INSTANTIATE_TEST_SUITE_P(
    Rows, PicturePosesBadRow,
    ::testing::Values(BadRow{"b.png,nan,5,6,0,1,0,0", "x_mm is \"nan\", a finite number is expected"},
                      BadRow{"b.png,4,inf,6,0,1,0,0", "y_mm is \"inf\", a finite number is expected"},
                      BadRow{"b.png,4,5,6,0,1,zero,0", "qy is \"zero\", a finite number is expected"},
                      BadRow{"b.png,4,5,6,0,0,0,0", "the quaternion is all zero"},
                      BadRow{"b.png,4,5,6,0,2,0,0", "the quaternion has length 2 instead of 1"},
                      BadRow{"b.png,4,5,6,0,1", "the row has 6 fields, 8 are expected"}));

}  // namespace
}  // namespace linescope
