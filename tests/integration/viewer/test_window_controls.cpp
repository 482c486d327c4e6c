// Each key does what the list on F1 says, read back from what the window shows; the daemon killed while
// navigating.
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>

#include "tests/integration/viewer/window_test.hpp"

namespace linescope::testing {
namespace {

QString text(const QJsonObject& shown, const char* key) {
  return shown[key].toString();
}
double number(const QJsonObject& shown, const char* key) {
  return shown[key].toDouble();
}
bool on(const QJsonObject& shown, const char* key) {
  return shown[key].toBool();
}

struct KeyCase {
  const char* key;
  const char* what;
  std::function<bool(const QJsonObject& before, const QJsonObject& after)> done;
};

bool turned(const QJsonObject& a, const QJsonObject& b, const char* key, double degrees) {
  return std::abs(std::remainder(number(b, key) - number(a, key) - degrees, 360)) < 0.1;
}

const KeyCase kKeys[] = {
    {"2", "surface",
     [](auto&, auto& s) { return text(s, "moment") == "surface" && number(s, "shown") == 2; }},
    {"p", "points", [](auto&, auto& s) { return number(s, "shown") == 0; }},
    {"g", "grid", [](auto&, auto& s) { return number(s, "shown") == 1; }},
    {"w", "wireframe", [](auto&, auto& s) { return number(s, "shown") == 3; }},
    {"s", "surface again", [](auto&, auto& s) { return number(s, "shown") == 2; }},
    {"n", "flat", [](auto&, auto& s) { return !on(s, "smooth"); }},
    {"bracketright", "coarser", [](auto&, auto& s) { return number(s, "surface_interval_mm") == 2.54; }},
    {"bracketleft", "finer", [](auto&, auto& s) { return number(s, "surface_interval_mm") == 1.27; }},
    {"o", "close holes", [](auto&, auto& s) { return number(s, "closing_holes_mm") == 20; }},
    {"m", "method", [](auto& b, auto& s) { return text(b, "surface_method") != text(s, "surface_method"); }},
    {"F7", "2x2", [](auto&, auto& s) { return number(s, "views") == 4 && number(s, "layout") == 2; }},
    {"F6", "1+3", [](auto&, auto& s) { return number(s, "views") == 4 && number(s, "layout") == 1; }},
    {"F5", "one view", [](auto&, auto& s) { return number(s, "views") == 1; }},
    {"Right", "azimuth", [](auto& b, auto& s) { return turned(b, s, "azimuth_deg", 5); }},
    {"Left", "azimuth back", [](auto& b, auto& s) { return turned(b, s, "azimuth_deg", -5); }},
    {"Down", "elevation", [](auto& b, auto& s) { return turned(b, s, "elevation_deg", -5); }},
    {"Up", "elevation back", [](auto& b, auto& s) { return turned(b, s, "elevation_deg", 5); }},
    {"comma", "roll", [](auto& b, auto& s) { return turned(b, s, "roll_deg", 5); }},
    {"period", "roll back", [](auto& b, auto& s) { return turned(b, s, "roll_deg", -5); }},
    {"plus", "nearer",
     [](auto& b, auto& s) { return number(s, "distance_mm") < 0.95 * number(b, "distance_mm"); }},
    {"minus", "farther",
     [](auto& b, auto& s) { return number(s, "distance_mm") > 1.05 * number(b, "distance_mm"); }},
    {"h", "follow", [](auto&, auto& s) { return on(s, "following"); }},
    {"r", "reset", [](auto&, auto& s) { return !on(s, "following"); }},
    {"f", "flip", [](auto&, auto& s) { return on(s, "flipped"); }},
    {"t", "next shape",
     [](auto& b, auto& s) { return text(b, "evaluation_shape") != text(s, "evaluation_shape"); }},
    {"d", "measure", [](auto&, auto& s) { return text(s, "measurement").contains("first point"); }},
    {"Escape", "give up", [](auto&, auto& s) { return text(s, "measurement").contains("press D"); }},
    {"a", "region", [](auto&, auto& s) { return text(s, "evaluation").contains("click the middle"); }},
    {"Escape", "give up", [](auto&, auto& s) { return !text(s, "evaluation").contains("click"); }},
    {"3", "navigate", [](auto&, auto& s) { return text(s, "moment") == "navigate"; }},
    {"1", "scan: the surface below the points",
     [](auto&, auto& s) { return text(s, "moment") == "scan" && on(s, "surface_visible"); }},
    {"p", "the points alone", [](auto&, auto& s) { return !on(s, "surface_visible"); }},
    {"F11", "full screen", [](auto&, auto& s) { return on(s, "full_screen"); }},
    {"F11", "window", [](auto&, auto& s) { return !on(s, "full_screen"); }},
    {"F2", "diagnostics", [](auto&, auto& s) { return on(s, "diagnostics_open"); }},
    {"F1", "keys", [](auto&, auto& s) { return on(s, "keys_open"); }},
};

TEST_F(WindowTest, EachKeyDoesWhatTheListSays) {
  FakeDaemon daemon(segment_);
  daemon.start_scan();
  daemon.publish_board();
  MovingTools tools(daemon, 10);
  ViewerUnderTest viewer(segment_, display_);
  ASSERT_TRUE(viewer.shows([](const QJsonObject& s) { return number(s, "triangles") > 100; }))
      << viewer.process().standard_error();
  for (const KeyCase& k : kKeys) {
    const QJsonObject before = viewer.shown();
    ASSERT_TRUE(viewer.press(k.key)) << k.key;
    ASSERT_TRUE(viewer.shows([&](const QJsonObject& s) { return k.done(before, s); }, 10s))
        << k.key << " (" << k.what << ")";
  }
}

// Looking straight down, a pixel is 2 * 60 mm * tan(15 degrees) / height of the view.
TEST_F(WindowTest, TwoClicksMeasureADistanceAndOneTakesARegion) {
  FakeDaemon daemon(segment_);
  daemon.start_scan();
  daemon.publish_board();
  TemporaryFolder folder;
  const auto script = folder.path() / "steps";
  FILE* out = std::fopen(script.c_str(), "w");
  ASSERT_NE(out, nullptr);
  std::fputs("wait-for triangles 100 30\ndo surface\ndo points\ncamepos 0 90 0 60\nwait 100\n", out);
  std::fclose(out);
  ViewerUnderTest viewer(segment_, display_, {"--script", script.string()});
  ASSERT_TRUE(viewer.shows([](const QJsonObject& s) {
    return std::abs(number(s, "elevation_deg") - 90) < 0.1 && std::abs(number(s, "distance_mm") - 60) < 0.1;
  })) << viewer.process().standard_error();
  const QJsonObject area = viewer.shown()["view_area"].toObject();
  const int x = area["x"].toInt() + area["width"].toInt() / 2,
            y = area["y"].toInt() + area["height"].toInt() / 2;
  const double mm_per_px = 2 * 60 * std::tan(radians_from_degrees(15)) / area["height"].toInt();
  ASSERT_TRUE(viewer.press("d"));
  ASSERT_TRUE(
      viewer.shows([](const QJsonObject& s) { return text(s, "measurement").contains("first point"); }));
  ASSERT_TRUE(viewer.click(x - 40, y));
  ASSERT_TRUE(viewer.shows([](const QJsonObject& s) { return text(s, "measurement").contains("second"); }));
  ASSERT_TRUE(viewer.click(x + 40, y));
  ASSERT_TRUE(viewer.shows([](const QJsonObject& s) { return number(s, "measured_mm") > 0; }));
  // Half the distance of two points of the board on either side.
  EXPECT_NEAR(number(viewer.shown(), "measured_mm"), 80 * mm_per_px, 0.25);
  ASSERT_TRUE(viewer.press("t"));
  ASSERT_TRUE(viewer.press("t"));
  ASSERT_TRUE(viewer.shows([](const QJsonObject& s) { return text(s, "evaluation_shape") == "plane"; }));
  ASSERT_TRUE(viewer.press("e"));
  EXPECT_TRUE(viewer.shows([](const QJsonObject& s) {
    return text(s, "evaluation").contains("0.00 ± 0.00 mm");
  })) << viewer.text("evaluation");
  ASSERT_TRUE(viewer.press("a"));
  ASSERT_TRUE(
      viewer.shows([](const QJsonObject& s) { return text(s, "evaluation").contains("click the middle"); }));
  ASSERT_TRUE(viewer.click(x, y));
  EXPECT_TRUE(viewer.shows([](const QJsonObject& s) {
    return on(s, "region_visible") && !on(s, "region_all") &&
           text(s, "evaluation").contains("0.00 ± 0.00 mm");
  })) << viewer.text("evaluation");
}

/// A daemon in a process of its own, so that it can be killed.
class DaemonProcess {
 public:
  explicit DaemonProcess(const std::string& segment) : pid_(fork()) {
    if (pid_ != 0) return;
    FakeDaemon daemon(segment);
    daemon.start_scan();
    daemon.publish_board();
    for (;;) {
      daemon.publish_tools(radians_from_degrees(7));
      std::this_thread::sleep_for(10ms);
    }
  }
  ~DaemonProcess() { kill_it(); }
  void kill_it() {
    if (pid_ <= 0) return;
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
    pid_ = -1;
  }

 private:
  pid_t pid_;
};

TEST_F(WindowTest, ADaemonKilledWhileNavigatingBlanksTheAngleInTimeAndComesBack) {
  DaemonProcess first(segment_);
  ViewerUnderTest viewer(segment_, display_);
  ASSERT_TRUE(viewer.shows(has_angle)) << viewer.process().standard_error();
  ASSERT_TRUE(viewer.press("3"));
  ASSERT_TRUE(viewer.shows([](const QJsonObject& s) { return s["triangles"].toInt() > 100; }));
  first.kill_it();
  const Nanoseconds end = monotonic_now() + 2 * kSecond;
  while (monotonic_now() < end) {
    const QJsonObject shown = viewer.shown();
    const Nanoseconds age =
        shown["time_ns"].toString().toLongLong() - shown["pose_time_ns"].toString().toLongLong();
    EXPECT_TRUE(!has_angle(shown) || age <= kStaleAfter) << age;
    std::this_thread::sleep_for(5ms);
  }
  const QJsonObject dead = viewer.shown();
  EXPECT_FALSE(has_angle(dead));
  EXPECT_TRUE(text(dead, "banner").contains("daemon")) << viewer.text("banner");
  EXPECT_TRUE(text(dead, "advice").contains("linescope-acquire")) << viewer.text("advice");
  EXPECT_TRUE(on(dead, "harvester_ghosted"));
  EXPECT_EQ(dead["points"].toInt(), 61 * 121) << "the surface is kept";
  EXPECT_GT(dead["triangles"].toInt(), 100);

  const Nanoseconds returned = monotonic_now();
  DaemonProcess second(segment_);
  ASSERT_TRUE(viewer.shows(has_angle));
  RecordProperty("seconds_until_the_angle_is_back", std::to_string(seconds_from(monotonic_now() - returned)));
  EXPECT_NEAR(angle_of(viewer.shown()), 7, 0.2);
}

}  // namespace
}  // namespace linescope::testing
