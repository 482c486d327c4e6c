// The twin speaks as a LIBERTY does: its bytes against the layout written down independently, and through the
// product's parser.
#include <gtest/gtest.h>

#include <cmath>

#include "acquire/tracker/liberty/binary_parser.hpp"
#include "acquire/twin/liberty_bytes.hpp"
#include "tests/unit/tracker/liberty_bytes.hpp"

namespace linescope::twin {
namespace {

using linescope::testing::Bytes;
using linescope::testing::Heard;
using linescope::testing::Wire;

LibertyRecord record() {
  LibertyRecord r;
  r.station = 1;
  r.frame_count = 480;
  r.milliseconds = 2000;
  r.world_from_sensor = {Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5), Eigen::Vector3d(312.5, -40.0, 75.0)};
  return r;
}

Bytes bytes_of(const LibertyRecord& r) {
  Bytes bytes;
  append_record(r, OutputList::for_options({}), bytes);
  return bytes;
}

TEST(LibertyBytes, AreThoseOfTheManual) {
  Wire wire;
  wire.station = 2;
  wire.frame = 480;
  wire.error = ' ';
  wire.position = {31.25F, -4.0F, 7.5F};
  wire.quaternion = {0.5F, -0.5F, 0.5F, 0.5F};
  EXPECT_EQ(bytes_of(record()), linescope::testing::pose_bytes(wire));
}

TEST(LibertyBytes, TheProductsParserReadsThemBack) {
  BinaryParser parser(OutputList::for_options({}), Expecting::poses);
  Heard heard;
  parser.feed(bytes_of(record()), heard);
  ASSERT_EQ(heard.readings.size(), 1u);
  const LibertyReading& reading = heard.readings.front();
  EXPECT_EQ(reading.station, 1);
  EXPECT_EQ(reading.frame_count, 480u);
  EXPECT_TRUE(reading.has_pose);
  EXPECT_NEAR((reading.position_mm - Eigen::Vector3d(312.5, -40, 75)).norm(), 0, 1e-9);
  EXPECT_NEAR(std::abs(reading.rotation.dot(Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5))), 1, 1e-12);
}

TEST(LibertyBytes, AnErrorIndicatorTravelsWithTheRecord) {
  LibertyRecord lost = record();
  lost.error = kOutsideMappedArea;
  BinaryParser parser(OutputList::for_options({}), Expecting::poses);
  Heard heard;
  parser.feed(bytes_of(lost), heard);
  ASSERT_EQ(heard.readings.size(), 1u);
  EXPECT_EQ(heard.readings.front().error, 'u');
}

}  // namespace
}  // namespace linescope::twin
