// The unmodified daemon binary on a serial line: a pseudo-terminal with the scripted unit at its other end.
#include <gmock/gmock.h>

#include "tests/integration/tracker/daemon_with_liberty.hpp"
#include "tests/integration/tracker/fake/serial_cable.hpp"

namespace linescope::testing {
namespace {

using ::testing::HasSubstr;

std::vector<std::string> on_line(const SerialCable& cable, std::vector<std::string> more = {}) {
  std::vector<std::string> all{
      "--set", "liberty.port=serial", "--set", "liberty.serial_device=" + cable.device(),
      "--set", "liberty.rate_hz=120", "--set", "liberty.stations=[1]"};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

TEST(DaemonOnSerialLine, HotStartFromEveryDirtyStateAndEverySampleArrives) {
  const std::vector<std::pair<const char*, std::function<void(FakeLiberty&)>>> dirty = {
      {"streaming in binary", [](FakeLiberty& unit) { unit.leave_streaming(true), unit.run_cycles(4); }},
      {"streaming in text", [](FakeLiberty& unit) { unit.leave_streaming(false), unit.run_cycles(3); }},
      {"half a command typed", [](FakeLiberty& unit) { unit.leave_half_typed("O*,2"); }},
      {"echo on", [](FakeLiberty& unit) { unit.set_echo(true); }},
  };
  for (const auto& [state, leave] : dirty) {
    SCOPED_TRACE(state);
    FakeLiberty unit(1);
    leave(unit);
    SerialCable cable(unit);
    DaemonWithLiberty daemon(unit, on_line(cable));
    ASSERT_TRUE(daemon.up()) << daemon.said();
    ASSERT_TRUE(DaemonWithLiberty::until([&] { return unit.streaming(); }));
    ASSERT_TRUE(daemon.measure(120, 1));
    EXPECT_EQ(daemon.published(), 120u);
    EXPECT_EQ(daemon.count(Counter::tracker_samples_lost), 0u);
    EXPECT_EQ(daemon.end(), 0);
    EXPECT_FALSE(unit.streaming());
  }
}

TEST(DaemonOnSerialLine, DamageIsCountedAndAPulledCableIsSaid) {
  FakeLiberty unit(1);
  SerialCable cable(unit);
  DaemonWithLiberty daemon(unit, on_line(cable));
  ASSERT_TRUE(daemon.up()) << daemon.said();
  ASSERT_TRUE(DaemonWithLiberty::until([&] { return unit.streaming(); }));
  ASSERT_TRUE(daemon.measure(8, 1));
  unit.inject(std::string("\x00\xffLX\x01", 5));
  unit.lose_cycles(2);
  ASSERT_TRUE(daemon.measure(8, 1));
  EXPECT_TRUE(daemon.until_count(Counter::tracker_samples_lost, 2));
  EXPECT_EQ(daemon.count(Counter::tracker_samples_lost), 2u);
  cable.pull();
  EXPECT_TRUE(DaemonWithLiberty::until([&] { return daemon.state().state == DaemonState::tracker_lost; }));
  EXPECT_EQ(daemon.sensor(0).state, ToolState::disconnected);
}

TEST(DaemonOnSerialLine, ARateThatDoesNotFitIsRefusedWithTheSum) {
  FakeLiberty unit(8);
  SerialCable cable(unit);
  std::vector<std::string> arguments = DaemonWithLiberty::arguments(on_line(cable));
  arguments.insert(arguments.end(), {"--set", "liberty.stations=[1,2,3]", "--set", "liberty.rate_hz=240"});
  const Outcome refused = run_daemon_to_end(arguments);
  EXPECT_NE(refused.exit_code, 0);
  EXPECT_THAT(refused.said, HasSubstr("52 bytes x 240 Hz x 3 sensor(s)"));
  EXPECT_FALSE(unit.streaming());
}

}  // namespace
}  // namespace linescope::testing
