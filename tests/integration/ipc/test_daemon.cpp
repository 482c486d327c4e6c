// The real daemon on its digital twin: killed at random instants at full speed, read from Python, looked at
// with linescope-inspect.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/integration/ipc/kill_series.hpp"
#include "tests/support/child_process.hpp"
#include "tests/support/finished_run.hpp"

namespace linescope::testing {
namespace {

using namespace std::chrono_literals;

const std::string kSource = LINESCOPE_SOURCE_DIR;
const std::string kPython = LINESCOPE_PYTHON;

#define LINESCOPE_NEEDS_PYTHON()                                                               \
  do {                                                                                         \
    if (kPython.empty()) {                                                                     \
      if (std::getenv("CI") != nullptr) GTEST_FAIL() << "python3 or its numpy is missing";     \
      GTEST_SKIP() << "python3 with numpy is not installed (packages python3, python3-numpy)"; \
    }                                                                                          \
  } while (false)

class RealDaemon : public ::testing::Test {
 protected:
  ~RealDaemon() override {
    daemon_.reset();
    remove_leftovers(name_);
  }

  std::vector<std::string> command(std::vector<std::string> more) const {
    std::vector<std::string> all{LINESCOPE_ACQUIRE,      "--segment", name_, "--set",
                                 "twin.scenario=sweeps", "--scan"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  /// Until it has published lines.
  void start() {
    daemon_ = std::make_unique<ChildProcess>(command({}));
    ASSERT_TRUE(eventually([&] { return lines() > 5; }, 60s)) << daemon_->standard_error();
  }
  std::size_t lines() const {
    auto reader = SegmentReader::attach({.name = name_});
    LineCursor cursor;
    LineBatch batch;
    if (reader && reader->life(monotonic_now()) == Life::live) reader->read_lines(cursor, batch);
    return batch.lines.size();
  }
  static Finished run(std::vector<std::string> arguments) { return run_to_end(std::move(arguments), 60s); }
  Finished inspect(std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {LINESCOPE_INSPECT, name_});
    return run(more);
  }

  const std::string name_ = unique_segment();
  std::unique_ptr<ChildProcess> daemon_;
};

/// What reading alone can tell; that it is as it was written, the checksum tells.
bool is_plausible(const Line& line, std::span<const SurfacePoint> points) {
  return !points.empty() && points.size() == line.point_count && line.endoscope.state == ToolState::ok &&
         std::all_of(points.begin(), points.end(), [](const SurfacePoint& p) {
           return p.position.allFinite() && p.standard_deviation > 0;
         });
}

TEST_F(RealDaemon, KilledAtAnyInstantAtFullSpeedHurtsNobody) {
  KillSeries series(name_, is_plausible);
  for (int i = 0; i < kills(4); ++i) {
    ChildProcess daemon(command({"--fast"}));
    ASSERT_TRUE(within(60 * kSecond, [&] { return series.lines_come(); })) << daemon.standard_error();
    series.kill(300'000, [&] {
      daemon.send(SIGKILL);
      daemon.wait(10s);
    });
    ASSERT_FALSE(HasFatalFailure());
  }
  series.expect_unharmed();
}

TEST_F(RealDaemon, IsReadFromPythonByTheTablesAlone) {
  LINESCOPE_NEEDS_PYTHON();
  start();
  const Finished read = run({kPython, "-B", kSource + "/tests/integration/ipc/check_daemon.py", name_,
                             kSource + "/docs/segment.md"});
  EXPECT_EQ(read.code, 0) << read.err;
  EXPECT_NE(read.out.find("lines checked"), std::string::npos);
  const Finished example = run({kPython, "-B", kSource + "/tools/attach.py", name_, "--once"});
  EXPECT_EQ(example.code, 0) << example.err;
  EXPECT_NE(example.out.find("live, scanning"), std::string::npos) << example.out;
  EXPECT_NE(example.out.find("endoscope ok ("), std::string::npos) << example.out;
}

/// Everything an operator or a script may ask for.
constexpr const char* kCheckInspect = R"(
import json, subprocess, sys
for _ in range(10):  # a starved daemon is silent for a moment: exit code 4
    done = subprocess.run(sys.argv[2:], capture_output=True, text=True)
    if done.returncode != 4:
        break
s = json.loads(done.stdout)
assert s['identity']['pid'] == int(sys.argv[1]) and s['identity']['program'].startswith('linescope-acquire'), s['identity']
assert s['life'] == 'live' and s['state'] == 'scanning' and s['scan']['lines'] > 0, s
assert [x['role'] for x in s['sensors']] == ['endoscope', 'object', 'harvester'], s['sensors']
for x in s['sensors']:
    rate = x['rate']
    assert x['state'] == 'ok' and rate['nominal_hz'] == 240 and abs(rate['hz'] - 240) < 2, x
    assert 0 < rate['period_sd_ms'] < 1 and rate['period_max_ms'] >= rate['period_mean_ms'], rate
rate = s['camera']['rate']
assert s['camera']['state'] == 'ok' and abs(rate['nominal_hz'] - 30) < .1 and abs(rate['hz'] - 30) < 1, s['camera']
c = s['counters']
for reason in ['frames_line_not_found', 'frames_no_pose_after', 'lines_segment_full', 'points_low_snr', 'tracker_samples_lost']:
    assert reason in c, reason
assert 0 < c['tracker_samples_published'] <= c['tracker_samples_received'], c
for stage in ['extract', 'reconstruct', 'publish_line', 'frame_total', 'publish_pose']:
    t = s['latencies'][stage]
    assert t['count'] > 0 and 0 < t['p50_ns'] <= t['p95_ns'] <= t['p99_ns'], (stage, t)
)";

TEST_F(RealDaemon, IsShownByInspectAndItsExitCodesTellScriptsWhatIsTheMatter) {
  LINESCOPE_NEEDS_PYTHON();
  EXPECT_EQ(inspect().code, 3) << "no segment yet";
  start();
  const Finished json = run({kPython, "-B", "-c", kCheckInspect, std::to_string(daemon_->pid()),
                             LINESCOPE_INSPECT, name_, "--json"});
  EXPECT_EQ(json.code, 0) << json.err;
  const Finished page = inspect();
  EXPECT_EQ(page.code, 0) << page.err;
  for (const char* shown : {"life      live", "state     scanning", "(nominal 240 Hz)", "(nominal 30 Hz)",
                            "spread", "p99", "lines_published"})
    EXPECT_NE(page.out.find(shown), std::string::npos) << shown << " in\n" << page.out;
  EXPECT_EQ(inspect({"--watch", "--times", "2", "--interval", "0.05"}).code, 0);
  daemon_->send(SIGKILL);
  ASSERT_TRUE(daemon_->wait(10s));
  std::this_thread::sleep_for(200ms);
  EXPECT_EQ(inspect().code, 4) << "dead, and still shown";
  start();  // takes over
  daemon_->send(SIGTERM);
  ASSERT_TRUE(daemon_->wait(10s));
  EXPECT_EQ(inspect().code, 3) << "an orderly end leaves nothing";
}

}  // namespace
}  // namespace linescope::testing
