// What was recorded gives the same points again, bit for bit, through the same program.
#include <gtest/gtest.h>
#include <signal.h>

#include <cstring>

#include "tests/integration/acquire/daemon_under_test.hpp"

namespace linescope::testing {
namespace {

using namespace std::chrono_literals;

std::vector<SurfacePoint> points_of(DaemonUnderTest& daemon, std::uint64_t pictures) {
  auto reader = daemon.attach();
  EXPECT_TRUE(reader) << daemon.process().standard_error();
  if (!reader) return {};
  // The last line is placed after its picture was counted: the state tells that the source is through.
  DaemonStatus status;
  EXPECT_TRUE(eventually(
      [&] {
        return counter(*reader, Counter::frames_received) >= pictures &&
               reader->status(status) == ReadOutcome::ok && status.state == DaemonState::idle;
      },
      60s));
  const LineBatch scan = whole_scan(*reader);
  return {scan.points.begin(), scan.points.end()};
}

bool same_bits(const std::vector<SurfacePoint>& a, const std::vector<SurfacePoint>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(SurfacePoint)) == 0;
}

TEST(RecordReplay, TheSameRecordingGivesTheSamePointsBitForBit) {
  TemporaryFolder folder;
  const std::string recording = folder.path() / "scan";
  DaemonUnderTest live({"--set", "twin.scenario=sweeps", "--set", "twin.duration_s=3", "--scan", "--fast",
                        "--record", recording});
  const auto first = points_of(live, 90);
  live.process().send(SIGTERM);
  ASSERT_TRUE(live.process().wait(10s));
  EXPECT_GT(first.size(), 5'000u);
  for (int i = 0; i < 2; ++i) {
    DaemonUnderTest replay({"--replay", recording, "--scan", "--fast"});
    EXPECT_TRUE(same_bits(first, points_of(replay, 90)));
  }
}

TEST(RecordReplay, AKilledRecorderLeavesAReadableRecording) {
  TemporaryFolder folder;
  const std::string recording = folder.path() / "scan";
  DaemonUnderTest live({"--set", "twin.scenario=sweeps", "--scan", "--record", recording});
  auto reader = live.attach();
  ASSERT_TRUE(reader) << live.process().standard_error();
  ASSERT_TRUE(eventually([&] { return counter(*reader, Counter::frames_received) >= 60; }));
  live.process().send(SIGKILL);
  ASSERT_TRUE(live.process().wait(10s));
  DaemonUnderTest replay({"--replay", recording, "--scan", "--fast"});
  // Two seconds were played, at most the last one may be lost.
  EXPECT_GT(points_of(replay, 30).size(), 1'000u);
}

TEST(RecordReplay, AFolderThatHoldsARecordingIsNotOverwritten) {
  TemporaryFolder folder;
  const std::string recording = folder.path() / "scan";
  ASSERT_EQ(
      run_daemon_to_end({"--set", "twin.duration_s=1", "--fast", "--exit-at-end", "--record", recording})
          .exit_code,
      0);
  const Outcome second =
      run_daemon_to_end({"--set", "twin.duration_s=1", "--fast", "--exit-at-end", "--record", recording});
  EXPECT_NE(second.exit_code, 0);
  EXPECT_NE(second.said.find(recording), std::string::npos) << second.said;
}

}  // namespace
}  // namespace linescope::testing
