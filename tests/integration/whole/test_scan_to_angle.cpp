// Both real programs: from the twin's pictures to the angle in the viewer's window, compared with what really
// is.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>
#include <regex>
#include <set>

#include "acquire/twin/twin_truth.hpp"
#include "acquire/twin/virtual_experiment.hpp"
#include "common/calibration.hpp"
#include "common/units.hpp"
#include "tests/integration/acquire/daemon_under_test.hpp"
#include "tests/support/virtual_display.hpp"

namespace linescope::testing {
namespace {

using namespace std::chrono_literals;

/// What the window says, as the viewer's --state-json gives it.
class Window {
 public:
  explicit Window(const std::filesystem::path& file) {
    std::ifstream in(file);
    text_.assign(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }

  std::string text(const std::string& key) const {
    return first(std::regex("\"" + key + "\": \"([^\"]*)\"")).value_or("");
  }
  double number(const std::string& key) const {
    return std::stod(first(std::regex("\"" + key + "\": (-?[0-9.e+-]+)")).value_or("-1"));
  }
  /// Degrees; nothing while the window shows a blank.
  std::optional<double> angle() const {
    const std::string shown = text("angle_text");
    if (shown.empty() || std::isdigit(static_cast<unsigned char>(shown.front())) == 0) return std::nullopt;
    return std::stod(shown);
  }

 private:
  std::optional<std::string> first(const std::regex& pattern) const {
    std::smatch match;
    if (!std::regex_search(text_, match, pattern)) return std::nullopt;
    return match[1].str();
  }

  std::string text_;
};

class ScanToAngle : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(display_.up()) << "Xvfb is needed: apt-get install xvfb"; }

  std::filesystem::path state_file() const { return folder_.path() / "state.json"; }
  Window window() const { return Window(state_file()); }

  ChildProcess viewer(const std::string& segment) const {
    return ChildProcess({LINESCOPE_VIEWER, "--segment", segment, "--state-json", state_file()},
                        {display_.variable()});
  }

  bool shows(const std::function<bool(const Window&)>& condition, std::chrono::seconds timeout = 60s) const {
    return eventually([&] { return condition(window()); }, timeout);
  }

  TemporaryFolder folder_;
  VirtualDisplay display_;
};

/// The sample of a station taken at `time`.
std::optional<PoseSample> sample_at(const SegmentReader& reader, int station, Nanoseconds time) {
  std::vector<PoseSample> samples;
  reader.pose_history(station, time - 3 * kMillisecond, time + 3 * kMillisecond, samples);
  if (samples.empty()) return std::nullopt;
  return *std::min_element(samples.begin(), samples.end(), [&](const PoseSample& a, const PoseSample& b) {
    return std::abs(a.time - time) < std::abs(b.time - time);
  });
}

/// Where the harvester's axis meets the phantom: along the axis by the distance that is certainly free, again
/// and again.
Eigen::Vector3d foot_of(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis,
                        const twin::TwinTruth& truth) {
  Eigen::Vector3d foot = tip;
  for (int i = 0; i < 100; ++i) foot -= truth.distance(foot) * axis;
  return foot;
}

/// Eq 5.3 with the phantom's own normal at the axis's foot, for the poses of that instant.
std::optional<double> true_angle_deg(const SegmentReader& reader, const twin::TwinTruth& truth,
                                     const Calibration& calibration, Nanoseconds time) {
  const auto object = sample_at(reader, 1, time), harvester = sample_at(reader, 2, time);
  if (!object || !harvester) return std::nullopt;
  const Rigid<Object, Harvester> object_from_harvester =
      renamed<World, Object>(object->world_from_sensor).inverse() *
      renamed<World, Harvester>(harvester->world_from_sensor);
  const Eigen::Vector3d tip = object_from_harvester * calibration.harvester.tip;
  const Eigen::Vector3d axis = object_from_harvester.rotate(calibration.harvester.axis);
  return degrees_from_radians(
      std::acos(std::clamp(truth.normal(foot_of(tip, axis, truth)).dot(axis), -1.0, 1.0)));
}

TEST_F(ScanToAngle, TheWindowShowsTheTrueAngle) {
  DaemonUnderTest daemon({"--scan", "--set", "twin.noise=ideal"});
  ChildProcess window_process = viewer(daemon.segment());
  auto reader = daemon.attach();
  ASSERT_TRUE(reader) << daemon.process().standard_error();
  std::string yaml;
  ASSERT_EQ(reader->calibration(yaml), ReadOutcome::ok);
  const auto calibration = calibration_from_text(yaml, "segment");
  ASSERT_TRUE(calibration) << calibration.error().message;
  twin::TwinOptions options = twin::demo_twin();
  ASSERT_TRUE(twin::apply_noise_preset(options, "ideal"));
  const auto experiment = twin::VirtualExperiment::create(options).value();

  ASSERT_TRUE(shows([](const Window& w) {
    return w.number("points") > 20'000 && w.number("triangles") > 300;
  })) << window_process.standard_error();
  std::set<std::string> compared;
  double worst = 0;
  eventually(
      [&] {
        const Window w = window();
        const std::string instant = w.text("pose_time_ns");
        if (!w.angle() || instant.empty() || compared.count(instant) > 0) return false;
        const auto truth = true_angle_deg(*reader, experiment->truth(), *calibration, std::stoll(instant));
        if (!truth) return false;
        worst = std::max(worst, std::abs(*truth - *w.angle()));
        compared.insert(instant);
        return compared.size() >= 20;
      },
      90s);
  std::printf("ideal twin: %zu angles compared, worst difference %.2f degrees\n", compared.size(), worst);
  ASSERT_GE(compared.size(), 20u);
  // The number on screen is rounded and moves with a dead-band of some tenths of a degree.
  EXPECT_LT(worst, 1.5);
}

TEST_F(ScanToAngle, TheViewerMayStartFirstAndSurvivesTheDaemonsDeath) {
  const std::string segment = unique_segment();
  ChildProcess window_process = viewer(segment);
  ASSERT_TRUE(shows([](const Window& w) { return w.text("link") == "searching" && !w.angle(); }))
      << window_process.standard_error();
  auto first = std::make_unique<DaemonUnderTest>(std::vector<std::string>{"--scan"}, segment);
  ASSERT_TRUE(
      shows([](const Window& w) { return w.text("link") == "attached" && w.number("points") > 5'000; }));
  const double pid = window().number("daemon_pid");
  EXPECT_EQ(static_cast<pid_t>(pid), first->process().pid());
  first->process().send(SIGKILL);
  first->process().wait(10s);
  EXPECT_TRUE(shows([](const Window& w) { return w.text("link") != "attached" && !w.angle(); }, 10s));
  EXPECT_GT(window().number("points"), 5'000) << "the surface is kept while the daemon is away";
  DaemonUnderTest second({"--scan"}, segment);
  EXPECT_TRUE(
      shows([&](const Window& w) { return w.text("link") == "attached" && w.number("daemon_pid") != pid; }));
  EXPECT_TRUE(window_process.running());
}

TEST_F(ScanToAngle, ANewViewerShowsTheWholeScanAndTheDaemonDoesNotNoticeTheOldOnesDeath) {
  DaemonUnderTest daemon({"--scan"});
  {
    ChildProcess old = viewer(daemon.segment());
    ASSERT_TRUE(shows([](const Window& w) { return w.number("points") > 3'000; })) << old.standard_error();
    old.send(SIGKILL);
    old.wait(10s);
  }
  std::filesystem::remove(state_file());
  auto reader = daemon.attach();
  ASSERT_TRUE(reader);
  ChildProcess next = viewer(daemon.segment());
  const double so_far = static_cast<double>(whole_scan(*reader).points.size());
  EXPECT_TRUE(shows([&](const Window& w) { return w.number("points") >= so_far; }));
  EXPECT_TRUE(daemon.process().running());
  EXPECT_EQ(counter(*reader, Counter::lines_offered), counter(*reader, Counter::lines_published));
}

TEST_F(ScanToAngle, TheViewerEndsInGoodOrderOnSigterm) {
  ChildProcess window_process = viewer(unique_segment());
  ASSERT_TRUE(shows([](const Window& w) { return w.text("link") == "searching"; }));
  window_process.send(SIGTERM);
  const auto end = window_process.wait(20s);
  ASSERT_TRUE(end);
  EXPECT_FALSE(end->signalled);
  EXPECT_EQ(end->code, 0) << window_process.standard_error();
}

}  // namespace
}  // namespace linescope::testing
