#include <gtest/gtest.h>

#include <random>
#include <set>

#include "acquire/tracker/liberty/binary_parser.hpp"
#include "liberty_bytes.hpp"

namespace linescope {
namespace {

using namespace testing;

class BinaryParserTest : public ::testing::Test {
 protected:
  void feed(const Bytes& bytes) { parser.feed(bytes, heard); }
  std::vector<std::uint32_t> frames() const {
    std::vector<std::uint32_t> list;
    for (const auto& reading : heard.readings) list.push_back(reading.frame_count);
    return list;
  }

  BinaryParser parser{OutputList::for_options({}), Expecting::poses};
  Heard heard;
};

TEST_F(BinaryParserTest, DecodesARecordWrittenByHand) {
  // 'L' 'Y', station 2, 'C', no error, reserved, 44 bytes; frame 258, 1075 ms, distortion 1, stylus 1,
  // (1.5, -2, 0.25) cm, quaternion (0.5, 0.5, 0.5, 0.5).
  feed({0x4c, 0x59, 0x02, 0x43, 0x00, 0x00, 0x2c, 0x00, 0x02, 0x01, 0x00, 0x00, 0x33,
        0x04, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x00, 0x00,
        0xc0, 0x3f, 0x00, 0x00, 0x00, 0xc0, 0x00, 0x00, 0x80, 0x3e, 0x00, 0x00, 0x00,
        0x3f, 0x00, 0x00, 0x00, 0x3f, 0x00, 0x00, 0x00, 0x3f, 0x00, 0x00, 0x00, 0x3f});
  ASSERT_EQ(heard.readings.size(), 1u);
  const LibertyReading& r = heard.readings[0];
  EXPECT_EQ(r.station, 1);
  EXPECT_EQ(r.frame_count, 258u);
  EXPECT_EQ(r.timestamp_ms, 1075u);
  EXPECT_EQ(r.distortion, 1);
  EXPECT_EQ(r.stylus, 1);
  EXPECT_TRUE(r.has_pose);
  EXPECT_EQ(r.position_mm, Eigen::Vector3d(15, -20, 2.5));
  EXPECT_EQ(r.rotation.coeffs(), Eigen::Vector4d(0.5, 0.5, 0.5, 0.5));
  EXPECT_EQ(parser.counters().skipped_bytes, 0u);
}

TEST_F(BinaryParserTest, AnySplitGivesTheSameRecords) {
  Bytes stream;
  for (std::uint32_t i = 0; i < 20; ++i)
    append(stream, pose_bytes({.station = 1 + static_cast<int>(i % 8), .frame = i}));
  for (const std::size_t step : {1u, 2u, 7u, 8u, 51u, 53u, 512u}) {
    BinaryParser fresh(OutputList::for_options({}), Expecting::poses);
    Heard got;
    for (std::size_t at = 0; at < stream.size(); at += step)
      fresh.feed(std::span(stream).subspan(at, std::min(step, stream.size() - at)), got);
    EXPECT_EQ(got.readings.size(), 20u) << step;
    EXPECT_EQ(fresh.counters().skipped_bytes, 0u) << step;
  }
}

TEST_F(BinaryParserTest, StepsOverGarbageByteByByte) {
  Bytes stream = pose_bytes({.frame = 1});
  append(stream, {0x00, 0xff, 'L', 'X', 'L'});
  append(stream, pose_bytes({.frame = 2}));
  append(stream, pose_bytes({.frame = 3}));
  feed(stream);
  EXPECT_EQ(frames(), (std::vector<std::uint32_t>{1, 2, 3}));
  EXPECT_EQ(parser.counters().skipped_bytes, 5u);
  EXPECT_EQ(parser.counters().resyncs, 1u);
}

TEST_F(BinaryParserTest, ALostByteCostsItsRecordOnly) {
  for (std::size_t lost = 0; lost < 52; ++lost) {
    BinaryParser fresh(OutputList::for_options({}), Expecting::poses);
    Heard got;
    Bytes stream = pose_bytes({.frame = 1});
    Bytes damaged = pose_bytes({.frame = 2});
    damaged.erase(damaged.begin() + static_cast<std::ptrdiff_t>(lost));
    append(stream, damaged);
    for (std::uint32_t i = 3; i < 6; ++i) append(stream, pose_bytes({.frame = i}));
    fresh.feed(stream, got);
    ASSERT_EQ(got.readings.size(), 4u) << lost;
    EXPECT_EQ(got.readings[1].frame_count, 3u) << lost;
  }
}

TEST_F(BinaryParserTest, NeverAcceptsAnotherLength) {
  for (int size = -1; size < 80; ++size) {
    if (size == 44) continue;
    Bytes record = pose_bytes({.frame = 7});
    const auto wrong = static_cast<std::int16_t>(size);
    std::memcpy(record.data() + 6, &wrong, 2);
    record.resize(static_cast<std::size_t>(std::max(8, 8 + size)));
    BinaryParser fresh(OutputList::for_options({}), Expecting::poses);
    Heard got;
    fresh.feed(record, got);
    fresh.feed(pose_bytes({.frame = 8}), got);
    ASSERT_EQ(got.readings.size(), 1u) << size;
    EXPECT_EQ(got.readings[0].frame_count, 8u);
  }
}

TEST_F(BinaryParserTest, NumbersThatCannotBeMeasuredAreRefused) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Wire> bad = {{.frame = 1, .position = {nan, 0, 0}},
                                 {.frame = 1, .position = {0, 0, 501}},
                                 {.frame = 1, .quaternion = {0, 0, 0, 0}},
                                 {.frame = 1, .quaternion = {1, 0.1F, 0, 0}},
                                 {.frame = 1, .distortion = 3}};
  for (const Wire& wire : bad) {
    BinaryParser fresh(OutputList::for_options({}), Expecting::poses);
    Heard got;
    fresh.feed(pose_bytes(wire), got);
    fresh.feed(pose_bytes({.frame = 2}), got);
    ASSERT_EQ(got.readings.size(), 1u);
    EXPECT_EQ(got.readings[0].frame_count, 2u);
    EXPECT_EQ(fresh.counters().bad_records, 1u);
  }
}

TEST_F(BinaryParserTest, ATagInsideTheDataDoesNotConfuse) {
  float tag_as_float = 0;
  const Bytes tag{'L', 'Y', 1, 'C'};
  std::memcpy(&tag_as_float, tag.data(), 4);
  feed(pose_bytes({.frame = 1, .position = {tag_as_float, tag_as_float, 0}}));
  feed(pose_bytes({.frame = 2}));
  EXPECT_EQ(frames(), (std::vector<std::uint32_t>{1, 2}));
}

TEST_F(BinaryParserTest, ARecordWithACoilErrorNeedsNoSaneNumbersButItsPlace) {
  Bytes stream = pose_bytes({.frame = 1, .error = 'b', .quaternion = {0, 0, 0, 0}});
  append(stream, pose_bytes({.frame = 2}));
  feed(stream);
  ASSERT_EQ(heard.readings.size(), 2u);
  EXPECT_EQ(heard.readings[0].error, 'b');
  EXPECT_FALSE(heard.readings[0].has_pose);
  // The same with something else behind it is damage.
  Bytes damaged = pose_bytes({.frame = 3, .error = 'b', .quaternion = {0, 0, 0, 0}});
  append(damaged, {1, 2, 3});
  feed(damaged);
  feed(pose_bytes({.frame = 4}));
  EXPECT_EQ(frames(), (std::vector<std::uint32_t>{1, 2, 4}));
}

TEST_F(BinaryParserTest, BothSpellingsOfNoErrorAreAccepted) {
  feed(pose_bytes({.frame = 1, .error = 0}));
  feed(pose_bytes({.frame = 2, .error = ' '}));
  EXPECT_EQ(heard.readings.size(), 2u);
}

TEST_F(BinaryParserTest, ErrorMessagesBetweenRecordsAreHandedOn) {
  feed(pose_bytes({.frame = 1}));
  feed(frame_bytes(0, 'X', 0x07, bytes_of("Above limit\r\n")));
  feed(pose_bytes({.frame = 2}));
  ASSERT_EQ(heard.answers.size(), 1u);
  EXPECT_EQ(heard.answers[0].error, 0x07);
  EXPECT_EQ(heard.answers[0].command, 'X');
  EXPECT_EQ(heard.answers[0].text, "Above limit\r\n");
  EXPECT_EQ(frames(), (std::vector<std::uint32_t>{1, 2}));
}

TEST_F(BinaryParserTest, AFalseMessageHeaderSwallowsNoRecords) {
  // A header that promises 104 bytes of text, and then two whole records: exactly 104 bytes.
  Bytes stream{'L', 'Y', 0, 'X', 0x07, 0, 104, 0};
  for (std::uint32_t i = 1; i < 5; ++i) append(stream, pose_bytes({.frame = i}));
  feed(stream);
  EXPECT_EQ(frames(), (std::vector<std::uint32_t>{1, 2, 3, 4}));
  EXPECT_TRUE(heard.answers.empty());
}

TEST_F(BinaryParserTest, AnswersAreReadDuringStartUpOnly) {
  const Bytes map = frame_bytes(0, 0x15, 0, {0xff, 0, 0x03, 0});
  feed(map);
  EXPECT_TRUE(heard.answers.empty());
  BinaryParser asking(OutputList::for_options({}), Expecting::answers);
  Heard got;
  asking.feed(map, got);
  ASSERT_EQ(got.answers.size(), 1u);
  EXPECT_EQ(got.answers[0].command, 0x15);
}

TEST_F(BinaryParserTest, RemembersTheTagOfAnotherProduct) {
  Bytes patriot = pose_bytes({.frame = 1});
  patriot[0] = 'P';
  patriot[1] = 'A';
  feed(patriot);
  EXPECT_TRUE(heard.readings.empty());
  EXPECT_EQ(parser.foreign_tag(), (std::array{'P', 'A'}));
}

/// Damage of every kind at random places; what is whole and at least two records behind the damage must come
/// through, and nothing that was never sent.
TEST_F(BinaryParserTest, ResynchronisesWithinTwoRecordsOfAnyDamage) {
  std::mt19937 random(20240607);
  const auto below = [&](std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
  };
  for (int round = 0; round < 2000; ++round) {
    BinaryParser fresh(OutputList::for_options({}), Expecting::poses);
    Heard got;
    Bytes stream;
    std::set<std::uint32_t> must;
    std::uint32_t frame = 100;
    std::size_t clean = 2;  // whole records since the last damage
    for (int piece = 0; piece < 40; ++piece) {
      Bytes record = pose_bytes({.station = 1 + static_cast<int>(frame % 8), .frame = frame});
      const std::size_t dice = below(12);
      if (dice == 0) {  // garbage in front
        for (std::size_t i = 0, n = 1 + below(120); i < n; ++i)
          stream.push_back(static_cast<std::uint8_t>(below(256)));
        clean = 0;
      } else if (dice == 1) {  // bytes lost
        const std::size_t at = below(record.size());
        record.erase(record.begin() + static_cast<std::ptrdiff_t>(at),
                     record.begin() + static_cast<std::ptrdiff_t>(at + 1 + below(record.size() - at)));
      } else if (dice == 2) {  // half of it twice
        record.insert(record.begin(), record.begin(),
                      record.begin() + static_cast<std::ptrdiff_t>(1 + below(50)));
      }
      const bool damaged = dice == 1 || dice == 2;
      clean = damaged ? 0 : clean + 1;
      if (!damaged && clean >= 2) must.insert(frame);
      append(stream, record);
      ++frame;
    }
    for (std::size_t at = 0; at < stream.size();) {
      const std::size_t n = std::min(1 + below(200), stream.size() - at);
      fresh.feed(std::span(stream).subspan(at, n), got);
      at += n;
    }
    std::set<std::uint32_t> seen;
    for (const auto& reading : got.readings) {
      EXPECT_TRUE(reading.frame_count >= 100 && reading.frame_count < frame)
          << "a record that was never sent";
      EXPECT_TRUE(seen.insert(reading.frame_count).second) << "a record came twice";
      EXPECT_EQ(reading.position_mm, Eigen::Vector3d(10, 20, 30));
    }
    for (const std::uint32_t wanted : must)
      EXPECT_TRUE(seen.count(wanted)) << "round " << round << " frame " << wanted;
  }
}

}  // namespace
}  // namespace linescope
