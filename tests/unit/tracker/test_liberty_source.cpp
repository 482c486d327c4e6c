#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acquire/tracker/liberty/liberty_source.hpp"
#include "tests/integration/tracker/fake/direct_line.hpp"

namespace linescope {
namespace {

using testing::DirectLine;
using testing::DirectTransport;
using testing::FakeLiberty;
using ::testing::HasSubstr;

/// Count-based: cycles are produced on demand and waited for with a long deadline that only a broken driver
/// reaches.
class LibertySourceTest : public ::testing::Test {
 protected:
  LibertySourceTest() {
    options.answer_timeout = 5 * kSecond;
    options.silence_limit = 30 * kSecond;  // a slow machine must not look like a silent unit
    options.retry_after = 5 * kMillisecond;
  }

  void start() {
    source = std::make_unique<LibertySource>(options, std::make_unique<DirectTransport>(line));
    const auto started = source->start();
    ASSERT_TRUE(started) << started.error().message;
  }

  /// Calls `step` and takes samples until `done` says so.
  template <class Done, class Step>
  bool until(Done done, Step step) {
    const Nanoseconds give_up = monotonic_now() + 30 * kSecond;
    PoseSample sample;
    while (!done()) {
      if (monotonic_now() > give_up) return false;
      step();
      const auto pull = source->next(sample);
      EXPECT_TRUE(pull);
      if (pull && *pull == Pull::item) samples.push_back(sample);
    }
    return true;
  }
  bool take(std::size_t count) {
    const std::size_t wanted = samples.size() + count;
    return until([&] { return samples.size() >= wanted; }, [] {});
  }
  /// The unit runs, a cycle per step, until `done`.
  template <class Done>
  bool run_until(Done done) {
    return until(done, [&] { line->unit.run_cycles(1); });
  }

  std::shared_ptr<DirectLine> line = std::make_shared<DirectLine>(3);
  LibertyOptions options;
  std::unique_ptr<LibertySource> source;
  std::vector<PoseSample> samples;
};

TEST_F(LibertySourceTest, DeliversEverySampleOfEverySensor) {
  start();
  for (int i = 0; i < 100; ++i) {
    line->unit.run_cycles(1);
    ASSERT_TRUE(take(3));
  }
  for (const PoseSample& sample : samples) {
    const auto expected = FakeLiberty::pose(sample.station, sample.frame_count);
    EXPECT_NEAR(sample.world_from_sensor.translation().x(), 10 * expected[0], 1e-4);
    EXPECT_NEAR(std::abs(sample.world_from_sensor.rotation().w()), std::abs(expected[3]), 1e-6);
    EXPECT_EQ(sample.state, ToolState::ok);
  }
  EXPECT_EQ(source->counters().samples, 300u);
  EXPECT_EQ(source->counters().lost, 0u);
  EXPECT_TRUE(source->status().delivering);
  EXPECT_THAT(source->status().sentence, HasSubstr("LIBERTY on the direct line: 3 sensor(s), 240 Hz"));
  EXPECT_EQ(source->station(0).samples, 100u);
  EXPECT_EQ(source->station(5).state, ToolState::never_seen);
}

TEST_F(LibertySourceTest, WithoutSamplesNextSaysNothingYet) {
  start();
  PoseSample sample;
  const auto pull = source->next(sample);
  ASSERT_TRUE(pull);
  EXPECT_EQ(*pull, Pull::nothing_yet);
}

TEST_F(LibertySourceTest, GarbageLossesAndMergedPacketsAreCountedNotSuffered) {
  line->unit.set_packets(33, 4);
  start();
  line->unit.run_cycles(4);
  ASSERT_TRUE(take(12));
  line->unit.inject(std::string("\x00\xffLX\x01", 5));
  line->unit.run_cycles(4);
  ASSERT_TRUE(take(12));
  line->unit.lose_cycles(7);
  line->unit.run_cycles(4);
  ASSERT_TRUE(take(12));
  EXPECT_EQ(source->counters().skipped_bytes, 5u);
  EXPECT_EQ(source->counters().resyncs, 1u);
  EXPECT_EQ(source->counters().lost, 21u);
}

TEST_F(LibertySourceTest, TheReasonOfABadStationIsInWords) {
  start();
  line->unit.set_error(1, 'c');
  line->unit.set_distortion(2, 2);
  line->unit.run_cycles(1);
  ASSERT_TRUE(take(3));
  EXPECT_EQ(source->station(0).reason, "");
  EXPECT_EQ(source->station(1).reason, "source coils X and Y failed");
  EXPECT_EQ(source->station(1).state, ToolState::missing);
  EXPECT_EQ(source->station(2).reason, "significant distortion: metal near by");
  line->unit.set_distortion(2, 1);
  line->unit.plug(1, false);
  ASSERT_TRUE(run_until([&] { return source->station(1).reason.find("unplugged") != std::string::npos; }));
  EXPECT_EQ(source->station(2).reason, "minor distortion: metal near by");
  EXPECT_EQ(source->station(2).state, ToolState::ok);
}

TEST_F(LibertySourceTest, AUnitThatFallsSilentIsStartedAgain) {
  options.silence_limit = 300 * kMillisecond;
  start();
  line->unit.run_cycles(2);
  ASSERT_TRUE(take(6));
  line->unit.go_quiet();
  ASSERT_TRUE(run_until([&] { return source->counters().reconnects >= 1; }));
  EXPECT_TRUE(source->status().delivering);
  EXPECT_EQ(line->opened, 1) << "the line itself was never given up";
}

TEST_F(LibertySourceTest, AProcessThatWasStoppedItselfDoesNotTakeTheUnitForSilent) {
  options.silence_limit = 300 * kMillisecond;
  start();
  line->unit.run_cycles(2);
  ASSERT_TRUE(take(6));
  const auto commands = line->unit.commands().size();
  line->stopped_for = kSecond;
  ASSERT_TRUE(until([&] { return line->stopped_for == 0; }, [] {}));
  line->unit.run_cycles(2);
  ASSERT_TRUE(take(6));
  EXPECT_EQ(source->counters().lost, 0u);
  EXPECT_EQ(line->unit.commands().size(), commands) << "the unit was asked nothing";
}

TEST_F(LibertySourceTest, AUnitSwitchedOffAndOnIsConfiguredAgain) {
  options.silence_limit = 300 * kMillisecond;
  start();
  line->unit.run_cycles(2);
  ASSERT_TRUE(take(6));
  line->unit.power_cycle();
  samples.clear();
  ASSERT_TRUE(run_until([&] { return source->counters().reconnects >= 1 && samples.size() > 20; }));
  EXPECT_TRUE(line->unit.binary());
  EXPECT_EQ(samples.back().state, ToolState::ok);
}

TEST_F(LibertySourceTest, UnplugAndReplug) {
  start();
  line->unit.run_cycles(2);
  ASSERT_TRUE(take(6));
  line->plugged = false;
  ASSERT_TRUE(take(3));
  for (std::size_t i = 6; i < 9; ++i) EXPECT_EQ(samples[i].state, ToolState::disconnected);
  ASSERT_TRUE(until([&] { return source->status().sentence == "the direct line is unplugged"; }, [] {}));
  EXPECT_FALSE(source->status().delivering);
  EXPECT_EQ(source->station(0).state, ToolState::disconnected);
  EXPECT_EQ(source->station(0).reason, "the LIBERTY is disconnected");
  line->unit.power_cycle();
  line->plugged = true;
  ASSERT_TRUE(
      run_until([&] { return source->counters().reconnects == 1 && samples.back().state == ToolState::ok; }));
  EXPECT_TRUE(source->status().delivering);
  std::array<Nanoseconds, 3> last{};
  for (const PoseSample& sample : samples) {
    EXPECT_GT(sample.time, last[sample.station]) << "times of a station always rise";
    last[sample.station] = sample.time;
  }
}

TEST_F(LibertySourceTest, TheLastSensorUnpluggedIsSaidAndItsReturnNoticed) {
  options.silence_limit = 300 * kMillisecond;
  line = std::make_shared<DirectLine>(1);
  start();
  line->unit.run_cycles(2);
  ASSERT_TRUE(take(2));
  line->unit.plug(0, false);
  ASSERT_TRUE(run_until(
      [&] { return source->status().sentence.find("no sensor is plugged in") != std::string::npos; }));
  EXPECT_EQ(source->station(0).state, ToolState::missing);
  line->unit.plug(0, true);
  ASSERT_TRUE(run_until([&] { return source->station(0).state == ToolState::ok; }));
}

TEST_F(LibertySourceTest, WhatMustBeThereAtStartFailsAtStart) {
  line->plugged = false;
  LibertySource absent(options, std::make_unique<DirectTransport>(line));
  const auto started = absent.start();
  ASSERT_FALSE(started);
  EXPECT_EQ(started.error().code, ErrorCode::not_found);
}

TEST_F(LibertySourceTest, WhatMayComeLaterIsWaitedFor) {
  options.required_at_start = false;
  line->plugged = false;
  start();
  EXPECT_EQ(source->status().sentence, "the direct line is unplugged");
  line->plugged = true;
  ASSERT_TRUE(run_until([&] { return samples.size() >= 3; }));
  EXPECT_EQ(source->counters().reconnects, 0u);
}

TEST_F(LibertySourceTest, NobodyTakingSamplesLosesTheOldestAndCounts) {
  start();
  for (int i = 0; i < 3000; ++i) {
    line->unit.run_cycles(1);
    while (line->unit.streaming() && line->unit.packets_waiting() > 2) std::this_thread::yield();
  }
  // 9000 samples came, 8192 fit, and nobody takes any before the last has arrived.
  const Nanoseconds give_up = monotonic_now() + 60 * kSecond;
  while (source->counters().queue_overruns < 808 && monotonic_now() < give_up)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_EQ(source->counters().queue_overruns, 808u);
  ASSERT_TRUE(take(8192));
  EXPECT_EQ(samples.front().frame_count, 270u)
      << "the oldest gave way: 808 of three sensors are 269 cycles and one";
  EXPECT_EQ(samples.back().frame_count, 3000u);
}

TEST_F(LibertySourceTest, StoppingLeavesAQuietUnit) {
  start();
  source.reset();
  EXPECT_FALSE(line->unit.streaming());
}

TEST_F(LibertySourceTest, BadOptionsAreRefusedBeforeAnythingHappens) {
  options.rate_hz = 100;
  LibertySource wrong(options, std::make_unique<DirectTransport>(line));
  EXPECT_THAT(wrong.start().error().message, HasSubstr("rate_hz is 100"));
  EXPECT_EQ(line->opened, 0);
}

}  // namespace
}  // namespace linescope
