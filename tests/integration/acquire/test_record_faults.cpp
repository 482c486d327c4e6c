// Recording by the real daemon while the disk is full.
#include <gtest/gtest.h>
#include <signal.h>

#include "tests/integration/acquire/daemon_under_test.hpp"

namespace linescope::testing {
namespace {

using namespace std::chrono_literals;

/// Why this machine lets us mount a file system of our own only in vain; empty: it lets us.
std::string no_mounts() {
  ChildProcess probe({"unshare", "--user", "--map-root-user", "--mount", "sh", "-c",
                      "mount -t tmpfs -o size=1m tmpfs /mnt"});
  const auto end = probe.wait(10s);
  if (end && !end->signalled && end->code == 0) return {};
  return "no user namespace with a mount of its own on this machine: " + probe.standard_error();
}

/// The daemon in a mount namespace in which `folder` is a file system of 4 MB: a dozen pictures.
ChildProcess daemon_on_small_disk(const std::filesystem::path& folder, const std::string& segment) {
  const std::string script = "mount -t tmpfs -o size=4m tmpfs " + folder.string() +
                             " && exec " LINESCOPE_ACQUIRE
                             " --set twin.scenario=sweeps --set run.record_keep_free_mb=0 --scan --segment " +
                             segment + " --record " + (folder / "scan").string();
  return ChildProcess({"unshare", "--user", "--map-root-user", "--mount", "sh", "-c", script});
}

TEST(RecordFaults, AFullFileSystemIsAStateTheScanGoesOnAndWhatWasWrittenIsReadable) {
  if (const std::string why = no_mounts(); !why.empty()) GTEST_SKIP() << why;
  TemporaryFolder folder;
  const std::string segment = unique_segment();
  ChildProcess daemon = daemon_on_small_disk(folder.path(), segment);
  std::optional<SegmentReader> reader;
  ASSERT_TRUE(eventually([&] {
    auto attached = SegmentReader::attach({.name = segment});
    if (attached) reader.emplace(std::move(*attached));
    return reader.has_value();
  })) << daemon.standard_error();

  DaemonStatus status;
  ASSERT_TRUE(eventually(
      [&] {
        return reader->status(status) == ReadOutcome::ok &&
               status.reason.find("the scan goes on") != std::string::npos;
      },
      60s))
      << status.reason << daemon.standard_error();
  EXPECT_EQ(status.state, DaemonState::scanning);
  ASSERT_TRUE(eventually([&] { return counter(*reader, Counter::recording_dropped) > 0; }));
  const std::uint64_t lines = counter(*reader, Counter::lines_published);
  EXPECT_TRUE(eventually([&] { return counter(*reader, Counter::lines_published) > lines + 10; }));

  // The small file system is seen through the daemon that lives in it.
  const std::string recording =
      "/proc/" + std::to_string(daemon.pid()) + "/root" + (folder.path() / "scan").string();
  DaemonUnderTest replay({"--replay", recording, "--scan", "--fast"});
  auto replayed = replay.attach();
  ASSERT_TRUE(replayed) << replay.process().standard_error();
  EXPECT_TRUE(eventually([&] { return counter(*replayed, Counter::frames_received) >= 3; }))
      << replay.process().standard_error();
  EXPECT_EQ(counter(*replayed, Counter::frames_unreadable), 0u);

  daemon.send(SIGTERM);
  const auto end = daemon.wait(20s);
  ASSERT_TRUE(end);
  EXPECT_EQ(end->code, 0) << daemon.standard_error();
}

}  // namespace
}  // namespace linescope::testing
