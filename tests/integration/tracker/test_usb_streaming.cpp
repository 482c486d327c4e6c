// A LIBERTY streaming over a mocked USB bus: everything that can happen to the stream, counted.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>

#include "tests/integration/tracker/driver_on_line.hpp"
#include "tests/integration/tracker/fake/fake_usb.hpp"

namespace linescope {
namespace {

using testing::DriverOnLine;
using testing::FakeBus;
using testing::FakeLiberty;
using testing::FakeUsb;
using testing::patient_options;

class LibertyUsbStreaming : public ::testing::Test {
 protected:
  void start() {
    const auto started = driver.source().start();
    ASSERT_TRUE(started) << started.error().message;
  }
  bool cycles(int count) {
    for (int i = 0; i < count; ++i) {
      unit.run_cycles(1);
      if (!driver.take(8)) return false;
    }
    return true;
  }
  TrackerCounters counters() { return driver.source().counters(); }

  FakeBus bus;
  FakeLiberty unit{8};
  FakeUsb usb{bus, unit};
  DriverOnLine driver{unit, patient_options()};
};

TEST_F(LibertyUsbStreaming, EightSensorsForAMinuteOfCyclesWithoutALoss) {
  start();
  constexpr int kCycles = 240 * 60;
  // Five cycles fit into the unit's buffer of 2300 bytes: never more than four are under way.
  for (int i = 0; i < kCycles; i += 4) {
    unit.run_cycles(4);
    ASSERT_TRUE(driver.take(8 * 4));
  }
  EXPECT_EQ(counters().samples, 8u * kCycles);
  EXPECT_EQ(counters().lost, 0u);
  EXPECT_EQ(counters().skipped_bytes, 0u);
  EXPECT_EQ(counters().out_of_order, 0u);
  EXPECT_EQ(counters().queue_overruns, 0u);
}

TEST_F(LibertyUsbStreaming, HotFromEveryDirtyState) {
  const std::vector<std::function<void()>> dirty = {
      [&] { unit.leave_streaming(true), unit.run_cycles(4); },
      [&] { unit.leave_streaming(false), unit.run_cycles(3); },
      [&] { unit.leave_half_typed("O*,2"); },
      [&] { unit.set_echo(true); },
  };
  for (std::size_t i = 0; i < dirty.size(); ++i) {
    SCOPED_TRACE(i);
    unit.power_cycle();
    dirty[i]();
    DriverOnLine again(unit, patient_options());
    const auto started = again.source().start();
    ASSERT_TRUE(started) << started.error().message;
    unit.run_cycles(1);
    ASSERT_TRUE(again.take(8));
    EXPECT_EQ(again.source().counters().lost, 0u);
  }
}

TEST_F(LibertyUsbStreaming, SplitAndMergedPackets) {
  unit.set_packets(61, 3);
  start();
  unit.run_cycles(3);
  ASSERT_TRUE(driver.take(24));
  unit.set_packets(512, 5);
  unit.run_cycles(5);
  ASSERT_TRUE(driver.take(40));
  EXPECT_EQ(counters().skipped_bytes, 0u);
  EXPECT_EQ(counters().lost, 0u);
}

TEST_F(LibertyUsbStreaming, GarbageLostBytesAndLostFrames) {
  start();
  ASSERT_TRUE(cycles(10));
  unit.inject(std::string("\x00\xffLX\x01", 5));
  ASSERT_TRUE(cycles(1));
  EXPECT_EQ(counters().skipped_bytes, 5u);
  unit.lose_cycles(3);
  ASSERT_TRUE(cycles(1));
  EXPECT_EQ(counters().lost, 24u);
  unit.drop_bytes(10);  // inside the first record of the next cycle
  unit.run_cycles(1);
  ASSERT_TRUE(driver.take(7));
  ASSERT_TRUE(cycles(1));
  EXPECT_EQ(counters().lost, 25u);
  EXPECT_EQ(counters().resyncs, 2u);
}

TEST_F(LibertyUsbStreaming, StallOverflowAndProtocolErrorAreRepaired) {
  start();
  ASSERT_TRUE(cycles(3));
  for (const int status : {-EPIPE, -EOVERFLOW, -EPROTO}) {
    usb.fail_next_in(status);
    ASSERT_TRUE(cycles(3)) << status;
  }
  ASSERT_TRUE(cycles(1));
  EXPECT_EQ(counters().transfer_faults, 3u);
  EXPECT_EQ(counters().lost, 0u);
}

TEST_F(LibertyUsbStreaming, TheUnitsBufferRunsOverAndTheLossIsCounted) {
  start();
  ASSERT_TRUE(cycles(5));
  {
    const FakeUsb::Hold hold(usb);  // the host does not fetch anything for 25 cycles
    unit.run_cycles(25);
  }
  const auto lost_cycles = unit.bytes_dropped_by_fifo() / (8 * 52);
  EXPECT_EQ(lost_cycles, 20u);
  ASSERT_TRUE(driver.take(8 * 5));
  ASSERT_TRUE(driver.run_until([&] { return counters().lost > 0; }));
  EXPECT_EQ(counters().lost, 8 * lost_cycles);
}

TEST_F(LibertyUsbStreaming, SensorsComeAndGo) {
  unit.plug(6, false);
  start();
  for (int i = 0; i < 10; ++i) {
    unit.run_cycles(1);
    ASSERT_TRUE(driver.take(7));
  }
  EXPECT_EQ(driver.source().station(6).state, ToolState::never_seen);
  unit.plug(6, true);
  ASSERT_TRUE(cycles(3));
  EXPECT_EQ(driver.source().station(6).state, ToolState::ok);
  unit.plug(2, false);
  ASSERT_TRUE(driver.run_until([&] { return driver.source().station(2).state == ToolState::missing; }));
  unit.plug(2, true);
  ASSERT_TRUE(driver.run_until([&] { return driver.source().station(2).state == ToolState::ok; }));
  EXPECT_EQ(counters().lost, 0u);
}

TEST_F(LibertyUsbStreaming, ErrorLettersBecomeReasons) {
  start();
  unit.set_error(3, 'g');
  unit.set_error(4, 'u');
  ASSERT_TRUE(cycles(1));
  EXPECT_EQ(driver.source().station(3).reason, "source coils X, Y and Z failed");
  EXPECT_EQ(driver.source().station(4).reason, "outside the mapped area");
  EXPECT_EQ(driver.source().station(4).state, ToolState::out_of_view);
  EXPECT_EQ(counters().device_errors, 2u);
}

}  // namespace
}  // namespace linescope
