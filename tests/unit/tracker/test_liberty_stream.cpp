#include <gtest/gtest.h>

#include "acquire/tracker/liberty/liberty_stream.hpp"
#include "liberty_bytes.hpp"

namespace linescope {
namespace {

using namespace testing;

constexpr Nanoseconds kCycle = 4'166'667;

class Samples : public SampleSink {
 public:
  void on_sample(const PoseSample& sample) override { all.push_back(sample); }
  void on_message(std::uint8_t error, std::string_view text) override { messages.emplace_back(error, text); }
  std::vector<PoseSample> of(int station) const {
    std::vector<PoseSample> some;
    for (const auto& sample : all)
      if (sample.station == station) some.push_back(sample);
    return some;
  }
  std::vector<PoseSample> all;
  std::vector<std::pair<std::uint8_t, std::string>> messages;
};

class LibertyStreamTest : public ::testing::Test {
 protected:
  static Nanoseconds arrival_of(std::uint32_t frame) {
    return kSecond + static_cast<Nanoseconds>(frame) * kCycle;
  }

  void cycle(std::uint32_t frame, const std::vector<Wire>& stations) {
    Bytes bytes;
    for (Wire wire : stations) {
      wire.frame = frame;
      append(bytes, pose_bytes(wire));
    }
    stream.feed(bytes, arrival_of(frame), samples);
  }
  void cycles(std::uint32_t from, std::uint32_t to, const std::vector<Wire>& stations) {
    for (std::uint32_t frame = from; frame < to; ++frame) cycle(frame, stations);
  }

  LibertyStream stream{LibertyOptions{}};
  Samples samples;
};

TEST_F(LibertyStreamTest, GivesSamplesWithPoseTimeAndCount) {
  cycles(10, 500, {{.station = 1, .position = {1, 2, 3}}, {.station = 3, .quaternion = {0, 1, 0, 0}}});
  EXPECT_EQ(samples.all.size(), 980u);
  const PoseSample last = samples.of(0).back();
  EXPECT_EQ(last.state, ToolState::ok);
  EXPECT_EQ(last.frame_count, 499u);
  EXPECT_EQ(last.world_from_sensor.translation(), Eigen::Vector3d(10, 20, 30));
  EXPECT_EQ(last.arrival, arrival_of(499));
  EXPECT_EQ(last.distortion, 0.0F);
  // The middle of the measurement lies 3.5 ms before the arrival.
  EXPECT_NEAR(static_cast<double>(last.time), static_cast<double>(arrival_of(499) - 3'500'000), 1000);
  EXPECT_EQ(samples.of(2).back().time, last.time) << "one cycle, one time";
  EXPECT_EQ(stream.counters().lost, 0u);
}

TEST_F(LibertyStreamTest, CountsLostFramesPerStation) {
  cycles(0, 50, {{.station = 1}, {.station = 2}});
  cycles(53, 60, {{.station = 1}, {.station = 2}});  // three cycles lost for both
  cycle(60, {{.station = 1}});                       // one record of station 2 lost
  cycle(61, {{.station = 1}, {.station = 2}});
  EXPECT_EQ(stream.station(0).lost, 3u);
  EXPECT_EQ(stream.station(1).lost, 4u);
  EXPECT_EQ(stream.counters().lost, 7u);
}

TEST_F(LibertyStreamTest, TheSameFrameTwiceIsDropped) {
  cycles(0, 5, {{.station = 1}});
  cycle(4, {{.station = 1}});
  cycle(3, {{.station = 1}});
  EXPECT_EQ(samples.all.size(), 5u);
  EXPECT_EQ(stream.counters().out_of_order, 2u);
}

TEST_F(LibertyStreamTest, AnUnpluggedSensorIsReportedOnceAndComesBackWithoutLosses) {
  cycles(0, 10, {{.station = 1}, {.station = 2}});
  cycles(10, 100, {{.station = 1}});
  const auto second = samples.of(1);
  ASSERT_EQ(second.size(), 11u);
  EXPECT_EQ(second.back().state, ToolState::missing);
  EXPECT_EQ(second.back().frame_count, 33u) << "24 cycles behind its last record";
  EXPECT_EQ(stream.station(1).state, ToolState::missing);
  cycles(100, 110, {{.station = 1}, {.station = 2}});
  EXPECT_EQ(stream.station(1).state, ToolState::ok);
  EXPECT_EQ(stream.station(1).lost, 0u);
  EXPECT_EQ(samples.of(1).size(), 21u);
}

TEST_F(LibertyStreamTest, ASensorPluggedInLaterAppears) {
  cycles(0, 10, {{.station = 1}});
  EXPECT_EQ(stream.station(4).state, ToolState::never_seen);
  cycles(10, 12, {{.station = 1}, {.station = 5}});
  EXPECT_EQ(stream.station(4).state, ToolState::ok);
  EXPECT_EQ(stream.counters().lost, 0u);
}

TEST_F(LibertyStreamTest, DistortionAndErrorsDecideTheState) {
  cycle(1, {{.station = 1, .distortion = 1}});
  EXPECT_EQ(stream.station(0).state, ToolState::ok);
  EXPECT_TRUE(stream.station(0).minor_distortion);
  cycle(2, {{.station = 1, .distortion = 2}});
  EXPECT_EQ(samples.all.back().state, ToolState::distorted_field);
  EXPECT_EQ(samples.all.back().distortion, 2.0F);
  cycle(3, {{.station = 1, .error = 'u'}});
  EXPECT_EQ(samples.all.back().state, ToolState::out_of_view);
  cycle(4, {{.station = 1, .error = 'e', .quaternion = {0, 0, 0, 0}}});
  EXPECT_EQ(samples.all.back().state, ToolState::missing);
  cycle(5, {{.station = 1, .error = 'I'}});
  EXPECT_EQ(samples.all.back().state, ToolState::ok);
  cycle(6, {{.station = 1}});
  EXPECT_EQ(stream.counters().device_errors, 3u);
}

TEST_F(LibertyStreamTest, TheLimitOfDistortionCanBeLowered) {
  LibertyOptions strict;
  strict.distortion_limit = 1;
  LibertyStream other(strict);
  other.feed(pose_bytes({.frame = 1, .distortion = 1}), kSecond, samples);
  EXPECT_EQ(samples.all.back().state, ToolState::distorted_field);
}

TEST_F(LibertyStreamTest, ARecordWithACountFromNowhereIsDropped) {
  cycles(0, 100, {{.station = 1}});
  stream.feed(pose_bytes({.frame = 0x40000000}), arrival_of(100), samples);
  cycles(100, 200, {{.station = 1}});
  EXPECT_EQ(samples.all.size(), 200u);
  EXPECT_EQ(stream.counters().doubtful_counts, 1u);
  EXPECT_EQ(stream.counters().lost, 0u);
}

TEST_F(LibertyStreamTest, TimesRiseAcrossARestartOfTheCounter) {
  cycles(5000, 5300, {{.station = 1}});
  Nanoseconds at = arrival_of(5300);
  for (std::uint32_t frame = 1; frame < 300; ++frame, at += kCycle)
    stream.feed(pose_bytes({.frame = frame}), at, samples);
  for (std::size_t i = 1; i < samples.all.size(); ++i)
    ASSERT_GT(samples.all[i].time, samples.all[i - 1].time) << i;
  EXPECT_EQ(stream.counters().epochs, 2u);
  EXPECT_EQ(stream.counters().lost, 0u);
  EXPECT_EQ(samples.all.size(), 300u + 299u - 2u) << "two records were spent on recognising it";
}

TEST_F(LibertyStreamTest, ASampleIsNeverMeasuredAfterItsArrivalLessTheLatency) {
  // Everything arrives in one bunch after a stall: later frames of the bunch must not be dated into the
  // future.
  Bytes bunch;
  for (std::uint32_t frame = 1; frame <= 40; ++frame) append(bunch, pose_bytes({.frame = frame}));
  stream.feed(bunch, 10 * kSecond, samples);
  for (const auto& sample : samples.all) EXPECT_LE(sample.time, 10 * kSecond - 3'500'000 + 40);
}

TEST_F(LibertyStreamTest, WhenTheUnitFallsSilentEveryStationSaysSoOnce) {
  cycles(0, 10, {{.station = 1}, {.station = 2}});
  stream.fall_silent(ToolState::disconnected, 2 * kSecond, samples);
  stream.fall_silent(ToolState::disconnected, 3 * kSecond, samples);
  ASSERT_EQ(samples.all.size(), 22u);
  EXPECT_EQ(samples.all.back().state, ToolState::disconnected);
  EXPECT_EQ(stream.station(2).state, ToolState::never_seen);
  // It comes back with one sensor only: the other one is missing then, not disconnected.
  stream.restart();
  Nanoseconds at = 4 * kSecond;
  for (std::uint32_t frame = 1; frame < 40; ++frame, at += kCycle)
    stream.feed(pose_bytes({.frame = frame}), at, samples);
  EXPECT_EQ(stream.station(0).state, ToolState::ok);
  EXPECT_EQ(stream.station(1).state, ToolState::missing);
}

TEST_F(LibertyStreamTest, MessagesOfTheUnitAreHandedOn) {
  cycle(1, {{.station = 1}});
  stream.feed(frame_bytes(0, 'C', 0x14, bytes_of("Sync lost\r\n")), arrival_of(2), samples);
  ASSERT_EQ(samples.messages.size(), 1u);
  EXPECT_EQ(samples.messages[0].first, 0x14);
  EXPECT_EQ(samples.messages[0].second, "Sync lost\r\n");
}

}  // namespace
}  // namespace linescope
