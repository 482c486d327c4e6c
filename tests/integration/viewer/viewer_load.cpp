// What a long scan does to the viewer: grows scans of a million points, one after the other, as fast as told,
// and reports how long events wait, how long pictures take and how much memory is used. Not a test of CTest:
// it takes minutes. docs/operators-guide.md has figures.
//
//   viewer_load [CYCLES] [LINES_PER_SECOND]     default 3 cycles of 2,000 lines, 200 lines per second;
//                                               54 cycles are an hour of scanning at 30 lines per second
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <thread>

#include "tests/integration/viewer/viewer_under_test.hpp"
#include "tests/unit/viewer/fake_daemon.hpp"

namespace linescope::testing {
namespace {

constexpr int kLines = 2'000, kPointsPerLine = 500;
constexpr double kScanRate = 30;  ///< lines per second of the real thing

void publish_line(FakeDaemon& daemon, int index) {
  std::vector<SurfacePoint> points;
  const double y = 0.02 * (index - kLines / 2);
  for (int i = 0; i < kPointsPerLine; ++i) {
    const double x = 0.1 * (i - kPointsPerLine / 2), z = -0.008 * (x * x + y * y);
    const Eigen::Vector3d place = FakeDaemon::world_from_object() * Eigen::Vector3d(x, y, z);
    points.push_back({place.cast<float>(), 200.0F, 0.05F});
  }
  ScanLineInfo info;
  info.time = monotonic_now();
  info.frame = static_cast<std::uint64_t>(index);
  info.object = {FakeDaemon::world_from_object(), ToolState::ok};
  info.endoscope = {FakeDaemon::world_from_endoscope(), ToolState::ok};
  daemon.writer().publish_line(info, points);
}

double resident_mb(pid_t pid) {
  std::ifstream status(fmt::format("/proc/{}/status", pid));
  for (std::string line; std::getline(status, line);)
    if (line.rfind("VmRSS:", 0) == 0) return std::stod(line.substr(6)) / 1024;
  return 0;
}

/// The largest of what the window said while a scan grew.
struct Worst {
  double event_p95 = 0, draw_p95 = 0;
  void consider(const QJsonObject& shown) {
    event_p95 = std::max(event_p95, shown["event_wait_p95_ms"].toDouble());
    draw_p95 = std::max(draw_p95, shown["draw_p95_ms"].toDouble());
  }
};

Worst grow(FakeDaemon& daemon, const ViewerUnderTest& viewer, double rate) {
  Worst worst;
  daemon.start_scan();
  const Nanoseconds begin = monotonic_now();
  for (int i = 0; i < kLines; ++i) {
    publish_line(daemon, i);
    if (i % 4 == 0) daemon.publish_tools(0.1);
    if (i % 50 == 0) worst.consider(viewer.shown());
    const Nanoseconds due = begin + nanoseconds_from_seconds(i / rate);
    if (due > monotonic_now()) std::this_thread::sleep_for(std::chrono::nanoseconds(due - monotonic_now()));
  }
  viewer.shows([](const QJsonObject& s) { return s["points"].toDouble() >= kLines * kPointsPerLine; });
  worst.consider(viewer.shown());
  return worst;
}

int run(int cycles, double rate) {
  VirtualDisplay display;
  if (!display.up()) return fmt::print("Xvfb is needed\n"), 1;
  FakeDaemon daemon(unique_segment(), kLines * kPointsPerLine + 1'000);
  ViewerUnderTest viewer(daemon.segment(), display);
  if (!viewer.shows([](const QJsonObject& s) { return s["link"].toString() == "attached"; })) return 1;
  viewer.press("2");
  fmt::print("cycle  points     triangles  event p95 ms  draw p95 ms  memory MB\n");
  Worst all;
  double first = 0, last = 0;
  for (int cycle = 1; cycle <= cycles; ++cycle) {
    const Worst worst = grow(daemon, viewer, rate);
    const QJsonObject shown = viewer.shown();
    last = resident_mb(viewer.process().pid());
    if (cycle == std::min(cycles, 3)) first = last;
    fmt::print("{:5}  {:9.0f}  {:9.0f}  {:12.1f}  {:11.1f}  {:9.0f}\n", cycle, shown["points"].toDouble(),
               shown["triangles"].toDouble(), worst.event_p95, worst.draw_p95, last);
    std::fflush(stdout);
    all.event_p95 = std::max(all.event_p95, worst.event_p95);
  }
  fmt::print(
      "{:.0f} minutes of scanning; worst event p95 {:.1f} ms (limit 100); memory after cycle 3 {:.0f} MB, at "
      "the end {:.0f} MB\n",
      cycles * kLines / kScanRate / 60, all.event_p95, first, last);
  return all.event_p95 < 100 && last < 1.1 * first ? 0 : 1;
}

}  // namespace
}  // namespace linescope::testing

int main(int argc, char** argv) {
  const int cycles = argc > 1 ? std::atoi(argv[1]) : 3;
  const double rate = argc > 2 ? std::atof(argv[2]) : 200;
  return linescope::testing::run(std::max(cycles, 1), std::max(rate, 1.0));
}
