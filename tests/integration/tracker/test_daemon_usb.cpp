// The unmodified daemon binary on a mocked USB bus: starts, everything that can happen to the stream, plugs.
#include <gmock/gmock.h>

#include <cerrno>
#include <cstdlib>
#include <functional>
#include <optional>

#include "tests/integration/tracker/daemon_with_liberty.hpp"
#include "tests/integration/tracker/fake/fake_usb.hpp"

namespace linescope::testing {
namespace {

using ::testing::HasSubstr;

/// Cycles of the test that loses nothing: four seconds in every check, a minute and real time on request.
struct LongRun {
  int cycles = 4 * 240;
  bool real_time = false;
};
LongRun long_run() {
  const char* seconds = std::getenv("LINESCOPE_LIBERTY_SECONDS");
  return seconds == nullptr ? LongRun{} : LongRun{240 * std::atoi(seconds), true};
}

class DaemonOnUsb : public ::testing::Test {
 protected:
  void start(const std::vector<std::string>& more = {}) {
    daemon.emplace(unit, more);
    ASSERT_TRUE(daemon->up()) << daemon->said();
    // The last commands may still be on their way when the segment is there.
    ASSERT_TRUE(DaemonWithLiberty::until([&] { return unit.streaming(); }));
  }
  bool cycles(int count) { return daemon->measure(count, 8); }

  FakeBus bus;
  FakeLiberty unit{8};
  std::optional<FakeUsb> usb;
  std::optional<DaemonWithLiberty> daemon;  // ends before the bus does
};

TEST_F(DaemonOnUsb, HotStartFromEveryDirtyState) {
  usb.emplace(bus, unit);
  const std::vector<std::pair<const char*, std::function<void()>>> dirty = {
      {"streaming in binary", [&] { unit.leave_streaming(true), unit.run_cycles(4); }},
      {"streaming in text", [&] { unit.leave_streaming(false), unit.run_cycles(3); }},
      {"half a command typed", [&] { unit.leave_half_typed("O*,2"); }},
      {"echo on", [&] { unit.set_echo(true); }},
      {"inches", [&] { unit.leave_units_inches(); }},
      {"self-test failed", [&] { unit.set_self_test_error(true); }},
      {"rubbish in its buffer",
       [&] {
         unit.inject(
             "LY\x01"
             "C rubbish");
       }},
  };
  for (const auto& [state, leave] : dirty) {
    SCOPED_TRACE(state);
    unit.power_cycle();
    leave();
    ASSERT_NO_FATAL_FAILURE(start());
    EXPECT_TRUE(cycles(2));
    EXPECT_EQ(daemon->published(), 16u);
    EXPECT_EQ(daemon->count(Counter::tracker_samples_lost), 0u);
    EXPECT_EQ(daemon->end(), 0) << daemon->said();
    EXPECT_FALSE(unit.streaming()) << "the unit is left quiet";
    daemon.reset();
    unit.set_self_test_error(false);
  }
}

TEST_F(DaemonOnUsb, EightSensorsWithoutALoss) {
  usb.emplace(bus, unit);
  ASSERT_NO_FATAL_FAILURE(start());
  const LongRun run = long_run();
  if (run.real_time) {
    const Nanoseconds begin = monotonic_now();
    for (int i = 0; i < run.cycles; ++i) {
      while (monotonic_now() < begin + i * (kSecond / 240))
        std::this_thread::sleep_for(std::chrono::microseconds(300));
      unit.run_cycles(1);
    }
    EXPECT_TRUE(daemon->until_count(Counter::tracker_samples_published, 8ULL * 240));
    std::this_thread::sleep_for(std::chrono::seconds(1));
    std::printf("%d cycles in %.2f s, %llu bytes dropped by the unit itself\n", run.cycles,
                seconds_from(monotonic_now() - begin) - 1,
                static_cast<unsigned long long>(unit.bytes_dropped_by_fifo()));
  } else {
    ASSERT_TRUE(cycles(run.cycles));
  }
  EXPECT_EQ(daemon->published(), 8u * static_cast<unsigned>(run.cycles));
  for (const Counter bad : {Counter::tracker_samples_lost, Counter::tracker_samples_unreadable,
                            Counter::tracker_samples_out_of_order, Counter::tracker_samples_not_finite,
                            Counter::tracker_reconnects})
    EXPECT_EQ(daemon->count(bad), 0u) << name(bad);
}

TEST_F(DaemonOnUsb, PosesAreThoseOfTheUnit) {
  usb.emplace(bus, unit);
  ASSERT_NO_FATAL_FAILURE(start());
  ASSERT_TRUE(cycles(10));
  for (int station = 0; station < 8; ++station) {
    PoseSample pose;
    ASSERT_EQ(daemon->reader().latest_pose(station, pose), ReadOutcome::ok);
    const auto expected = FakeLiberty::pose(station, pose.frame_count);
    EXPECT_NEAR(pose.world_from_sensor.translation().x(), 10 * static_cast<double>(expected[0]), 1e-3);
    EXPECT_EQ(pose.state, ToolState::ok);
  }
}

TEST_F(DaemonOnUsb, SplitAndMergedPacketsGarbageAndLostFrames) {
  usb.emplace(bus, unit);
  unit.set_packets(61, 3);
  ASSERT_NO_FATAL_FAILURE(start());
  ASSERT_TRUE(daemon->measure(6, 8, 3));
  unit.set_packets(512, 5);
  ASSERT_TRUE(daemon->measure(10, 8, 5));
  unit.set_packets(512, 1);
  unit.inject(std::string("\x00\xffLX\x01", 5));
  ASSERT_TRUE(cycles(4));
  EXPECT_EQ(daemon->count(Counter::tracker_samples_lost), 0u);
  unit.lose_cycles(3);
  ASSERT_TRUE(cycles(1));
  EXPECT_TRUE(daemon->until_count(Counter::tracker_samples_lost, 24));
  unit.drop_bytes(10);  // inside the first record of the next cycle
  unit.run_cycles(1);
  ASSERT_TRUE(cycles(1));
  EXPECT_TRUE(daemon->until_count(Counter::tracker_samples_lost, 25));
  EXPECT_EQ(daemon->count(Counter::tracker_samples_lost), 25u);
}

TEST_F(DaemonOnUsb, StallOverflowProtocolErrorAndARunOverBuffer) {
  usb.emplace(bus, unit);
  ASSERT_NO_FATAL_FAILURE(start());
  ASSERT_TRUE(cycles(4));
  for (const int status : {-EPIPE, -EOVERFLOW, -EPROTO}) {
    usb->fail_next_in(status);
    ASSERT_TRUE(cycles(4)) << status;
  }
  EXPECT_EQ(daemon->count(Counter::tracker_samples_lost), 0u);
  {
    const FakeUsb::Hold hold(*usb);  // nobody fetches anything for 25 cycles
    unit.run_cycles(25);
  }
  const auto lost = unit.bytes_dropped_by_fifo() / 52;
  EXPECT_GT(lost, 0u);
  ASSERT_TRUE(daemon->measure_until([&] { return daemon->count(Counter::tracker_samples_lost) > 0; }));
  EXPECT_TRUE(daemon->until_count(Counter::tracker_samples_lost, lost));
  EXPECT_EQ(daemon->count(Counter::tracker_samples_lost), lost);
  EXPECT_EQ(daemon->state().state, DaemonState::idle);
}

TEST_F(DaemonOnUsb, SensorsComeAndGoAndSayWhatAilsThem) {
  usb.emplace(bus, unit);
  unit.plug(2, false);
  ASSERT_NO_FATAL_FAILURE(start());
  ASSERT_TRUE(daemon->measure(8, 7));
  EXPECT_EQ(daemon->sensor(2).state, ToolState::never_seen);
  unit.plug(2, true);
  ASSERT_TRUE(daemon->measure_until([&] { return daemon->sensor(2).state == ToolState::ok; }));
  unit.plug(0, false);
  ASSERT_TRUE(daemon->measure_until([&] { return daemon->sensor(0).state == ToolState::missing; }));
  EXPECT_THAT(daemon->sensor(0).reason, HasSubstr("unplugged"));
  unit.plug(0, true);
  ASSERT_TRUE(daemon->measure_until([&] { return daemon->sensor(0).state == ToolState::ok; }));
  unit.set_error(3, 'g');
  unit.set_error(4, 'u');
  unit.set_distortion(5, 2);
  ASSERT_TRUE(daemon->measure_until([&] { return daemon->sensor(5).state == ToolState::distorted_field; }));
  ASSERT_TRUE(daemon->measure_until([&] { return daemon->sensor(4).state == ToolState::out_of_view; }));
  EXPECT_EQ(daemon->sensor(3).reason, "source coils X, Y and Z failed");
  EXPECT_EQ(daemon->sensor(4).reason, "outside the mapped area");
  EXPECT_EQ(daemon->sensor(5).reason, "significant distortion: metal near by");
  EXPECT_EQ(daemon->count(Counter::tracker_samples_lost), 0u);
}

TEST_F(DaemonOnUsb, UnpluggedReloadedRenumeratedAndBack) {
  usb.emplace(bus, unit, UsbPlace{.device = 10});
  ASSERT_NO_FATAL_FAILURE(start());
  ASSERT_TRUE(cycles(8));
  usb->unplug();
  ASSERT_TRUE(DaemonWithLiberty::until([&] { return daemon->state().state == DaemonState::tracker_lost; }));
  ASSERT_TRUE(DaemonWithLiberty::until([&] { return daemon->sensor(0).state == ToolState::disconnected; }));
  unit.power_cycle();
  usb.emplace(bus, unit, UsbPlace{.product = 0xff21, .device = 11});
  ASSERT_TRUE(DaemonWithLiberty::until(
      [&] { return daemon->state().reason.find("waits for its firmware") != std::string::npos; }));
  usb.emplace(bus, unit, UsbPlace{.device = 12});
  ASSERT_TRUE(daemon->measure_until([&] { return daemon->count(Counter::tracker_reconnects) == 1; }));
  ASSERT_TRUE(daemon->measure_until([&] { return daemon->sensor(0).state == ToolState::ok; }));
  ASSERT_TRUE(DaemonWithLiberty::until([&] { return daemon->state().state == DaemonState::idle; }));
  EXPECT_EQ(daemon->end(), 0);
}

TEST_F(DaemonOnUsb, AUnitThatFallsSilentIsStartedAgain) {
  usb.emplace(bus, unit);
  ASSERT_NO_FATAL_FAILURE(start({"--set", "liberty.silence_limit_ms=1000"}));
  ASSERT_TRUE(cycles(4));
  unit.go_quiet();
  ASSERT_TRUE(daemon->measure_until([&] { return daemon->count(Counter::tracker_reconnects) == 1; }));
  EXPECT_TRUE(unit.streaming());
}

TEST_F(DaemonOnUsb, ListAndCheckLookButSendNothing) {
  FakeLiberty other(1);
  usb.emplace(bus, unit, UsbPlace{.device = 10, .port = "2"});
  FakeUsb loader(bus, other, {.product = 0xff21, .device = 11, .port = "3"});
  ChildProcess list({LINESCOPE_ACQUIRE, "--list"});
  ASSERT_TRUE(list.wait(std::chrono::seconds(20)));
  const std::string listed = list.standard_output();
  EXPECT_THAT(listed, HasSubstr("tracker USB 1-2 (0f44:ff20)  LIBERTY  usable"));
  EXPECT_THAT(listed, HasSubstr("USB 1-3 (0f44:ff21)"));
  EXPECT_THAT(listed, HasSubstr("waits for its firmware"));
  EXPECT_THAT(listed, HasSubstr("camera"));
  const Outcome good = run_daemon_to_end(DaemonWithLiberty::arguments({"--check"}));
  EXPECT_EQ(good.exit_code, 0) << good.said;
  EXPECT_TRUE(unit.commands().empty()) << "looking sends nothing";
  usb->set_claim_error(EBUSY);
  const Outcome busy = run_daemon_to_end(DaemonWithLiberty::arguments({"--check"}));
  EXPECT_EQ(busy.exit_code, 6);
  EXPECT_THAT(busy.said, HasSubstr("is in use by another program"));
}

TEST_F(DaemonOnUsb, NoUnitIsARefusalOrSomethingToWaitFor) {
  const Outcome refused = run_daemon_to_end(DaemonWithLiberty::arguments({}));
  EXPECT_EQ(refused.exit_code, 6);
  EXPECT_THAT(refused.said, HasSubstr("there is none on USB (0f44:ff20); switch it on and plug it in"));
  daemon.emplace(unit, std::vector<std::string>{"--set", "liberty.required_at_start=false"});
  ASSERT_TRUE(daemon->up()) << daemon->said();
  ASSERT_TRUE(DaemonWithLiberty::until([&] { return daemon->state().state == DaemonState::tracker_lost; }));
  usb.emplace(bus, unit);
  ASSERT_TRUE(daemon->measure_until([&] { return daemon->published() > 0; }));
}

}  // namespace
}  // namespace linescope::testing
