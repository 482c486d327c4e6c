#include <gtest/gtest.h>

#include "acquire/tracker/liberty/ascii_parser.hpp"
#include "liberty_bytes.hpp"

namespace linescope {
namespace {

using namespace testing;

LibertyOptions ascii_options() {
  LibertyOptions options;
  options.format = LibertyFormat::ascii;
  return options;
}

class AsciiParserTest : public ::testing::Test {
 protected:
  void feed(const std::string& text) { parser.feed(bytes_of(text), heard); }
  AsciiParser parser{OutputList::for_options(ascii_options())};
  Heard heard;
};

const std::string kLine =
    "03  1234 5141 1 0   12.345 -67.890    0.125  0.50000 -0.50000  0.50000 -0.50000 \r\n";

TEST_F(AsciiParserTest, ReadsALine) {
  feed(kLine);
  ASSERT_EQ(heard.readings.size(), 1u);
  const LibertyReading& r = heard.readings[0];
  EXPECT_EQ(r.station, 2);
  EXPECT_EQ(r.error, 0);
  EXPECT_EQ(r.frame_count, 1234u);
  EXPECT_EQ(r.timestamp_ms, 5141u);
  EXPECT_EQ(r.distortion, 1);
  EXPECT_EQ(r.stylus, 0);
  EXPECT_LT((r.position_mm - Eigen::Vector3d(123.45, -678.9, 1.25)).norm(), 1e-9);
  EXPECT_EQ(r.rotation.coeffs(), Eigen::Vector4d(-0.5, 0.5, -0.5, 0.5));
}

TEST_F(AsciiParserTest, ReadsTheErrorLetterDirectlyBehindTheStation) {
  feed("01a 7 29 0 0 0.000 0.000 0.000 0.00000 0.00000 0.00000 0.00000 \r\n");
  ASSERT_EQ(heard.readings.size(), 1u);
  EXPECT_EQ(heard.readings[0].error, 'a');
  EXPECT_FALSE(heard.readings[0].has_pose);
}

TEST_F(AsciiParserTest, SplitAnywhere) {
  for (std::size_t at = 1; at < kLine.size(); ++at) {
    AsciiParser fresh(OutputList::for_options(ascii_options()));
    Heard got;
    fresh.feed(bytes_of(kLine.substr(0, at)), got);
    fresh.feed(bytes_of(kLine.substr(at)), got);
    EXPECT_EQ(got.readings.size(), 1u) << at;
  }
}

TEST_F(AsciiParserTest, ALineWithTooFewOrTooManyNumbersIsRefused) {
  feed("03  1234 5141 1 0   12.345 -67.890    0.125  0.50000 -0.50000  0.50000 \r\n");
  feed("03  1234 5141 1 0   12.345 -67.890    0.125  0.50000 -0.50000  0.50000 -0.50000  9\r\n");
  feed("03  12x4 5141 1 0   12.345 -67.890    0.125  0.50000 -0.50000  0.50000 -0.50000 \r\n");
  feed("03  12.5 5141 1 0   12.345 -67.890    0.125  0.50000 -0.50000  0.50000 -0.50000 \r\n");
  feed("03  1234 5141 1 0   12.345 -67.890    0.125  0.50000 -0.50000  0.50000 -0.40000 \r\n");
  EXPECT_TRUE(heard.readings.empty());
  EXPECT_EQ(parser.counters().bad_records, 5u);
  feed(kLine);
  EXPECT_EQ(heard.readings.size(), 1u);
  EXPECT_EQ(parser.counters().resyncs, 1u);
}

TEST_F(AsciiParserTest, TextIsHandedOnAndGarbageEndsAtTheNextLine) {
  feed("Invalid Command\r\n");
  ASSERT_EQ(heard.answers.size(), 1u);
  EXPECT_EQ(heard.answers[0].text, "Invalid Command");
  feed("\x01\xff\x80 03 \r\n" + kLine);
  EXPECT_EQ(heard.readings.size(), 1u);
  EXPECT_EQ(heard.answers.size(), 1u);
}

TEST_F(AsciiParserTest, AnEndlessLineCostsItselfOnly) {
  feed(std::string(5000, '7'));
  feed("\r\n" + kLine);
  EXPECT_EQ(heard.readings.size(), 1u);
  EXPECT_GE(parser.counters().skipped_bytes, 5000u);
}

}  // namespace
}  // namespace linescope
