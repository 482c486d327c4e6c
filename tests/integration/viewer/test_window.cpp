// The real viewer, a daemon under the test's control, real keys and clicks.
#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "tests/integration/viewer/window_test.hpp"

namespace linescope::testing {
namespace {

TEST_F(WindowTest, ShowsTheAngleOfAKnownHarvesterOverAKnownBoard) {
  FakeDaemon daemon(segment_);
  daemon.start_scan();
  daemon.publish_board();
  MovingTools tools(daemon, 10);
  ViewerUnderTest viewer(segment_, display_);
  ASSERT_TRUE(viewer.shows(has_angle)) << viewer.process().standard_error();
  const QJsonObject shown = viewer.shown();
  EXPECT_NEAR(angle_of(shown), 10.0, 0.1);
  EXPECT_EQ(shown["points"].toInt(), 61 * 121);
  EXPECT_TRUE(shown["normal_visible"].toBool());
  EXPECT_TRUE(shown["harvester_visible"].toBool());
  EXPECT_FALSE(shown["harvester_ghosted"].toBool());
  EXPECT_TRUE(viewer.shows([](const QJsonObject& s) { return s["triangles"].toInt() > 100; }));
}

// What is displayed is never older than 0.2 s: the angle is gone before, and comes back by itself.
TEST_F(WindowTest, AFrozenTrackerBlanksTheAngleInTime) {
  FakeDaemon daemon(segment_);
  daemon.start_scan();
  daemon.publish_board();
  MovingTools tools(daemon, 5);
  ViewerUnderTest viewer(segment_, display_);
  ASSERT_TRUE(viewer.shows(has_angle)) << viewer.process().standard_error();
  tools.freeze();
  const Nanoseconds end = monotonic_now() + 2 * kSecond;
  while (monotonic_now() < end) {
    const QJsonObject shown = viewer.shown();
    if (has_angle(shown)) {
      const Nanoseconds age =
          shown["time_ns"].toString().toLongLong() - shown["pose_time_ns"].toString().toLongLong();
      EXPECT_LE(age, kStaleAfter);
    }
    std::this_thread::sleep_for(5ms);
  }
  ASSERT_FALSE(has_angle(viewer.shown()));
  EXPECT_NE(viewer.text("angle_reason").find("stale"), std::string::npos) << viewer.text("angle_reason");
  EXPECT_TRUE(viewer.shown()["harvester_ghosted"].toBool());
  EXPECT_FALSE(viewer.shown()["normal_visible"].toBool());
  tools.thaw();
  EXPECT_TRUE(viewer.shows(has_angle));
}

TEST_F(WindowTest, AnUnpluggedHarvesterIsNamedWithTheTrackersReason) {
  FakeDaemon daemon(segment_);
  daemon.start_scan();
  daemon.publish_board();
  MovingTools tools(daemon, 5);
  ViewerUnderTest viewer(segment_, display_);
  ASSERT_TRUE(viewer.shows(has_angle)) << viewer.process().standard_error();
  tools.set_harvester(ToolState::missing);
  ASSERT_TRUE(viewer.shows([](const QJsonObject& s) { return !has_angle(s); }));
  EXPECT_NE(viewer.text("angle_reason").find("the test says so"), std::string::npos);
  EXPECT_NE(viewer.text("banner").find("Harvester"), std::string::npos);
  tools.set_harvester(ToolState::ok);
  tools.set_object(ToolState::out_of_view);
  ASSERT_TRUE(
      viewer.shows([](const QJsonObject& s) { return s["angle_reason"].toString().startsWith("Object"); }));
  EXPECT_EQ(viewer.shown()["points"].toInt(), 61 * 121) << "the surface stays";
}

TEST_F(WindowTest, AFullSegmentIsSaidWithWhatToDo) {
  FakeDaemon daemon(segment_, 2'000);
  daemon.start_scan();
  PublishOutcome last = PublishOutcome::stored;
  for (int i = 0; i < 40; ++i) last = daemon.publish_line(0.2 * i);
  ASSERT_EQ(last, PublishOutcome::full);
  ViewerUnderTest viewer(segment_, display_);
  ASSERT_TRUE(viewer.shows([](const QJsonObject& s) { return s["full"].toBool(); }))
      << viewer.process().standard_error();
  EXPECT_NE(viewer.text("banner").find("full"), std::string::npos);
  EXPECT_NE(viewer.text("advice").find("Clear"), std::string::npos);
}

TEST_F(WindowTest, KeysAndButtonsBecomeCommandsAndMoments) {
  FakeDaemon daemon(segment_);
  ViewerUnderTest viewer(segment_, display_);
  ASSERT_TRUE(viewer.shows([](const QJsonObject& s) { return s["link"].toString() == "attached"; }))
      << viewer.process().standard_error();
  std::vector<CommandKind> received;
  const auto receives = [&](CommandKind kind) {
    return eventually(
        [&] {
          for (const CommandKind k : daemon.poll_commands()) received.push_back(k);
          return !received.empty() && received.back() == kind;
        },
        10s);
  };
  ASSERT_TRUE(viewer.press("space"));
  EXPECT_TRUE(receives(CommandKind::start));
  daemon.start_scan();
  ASSERT_TRUE(viewer.shows([](const QJsonObject& s) { return s["scanning"].toBool(); }));
  ASSERT_TRUE(viewer.click(60, 26)) << "the button that now says Stop";
  EXPECT_TRUE(receives(CommandKind::stop));
  ASSERT_TRUE(viewer.press("BackSpace"));
  EXPECT_TRUE(receives(CommandKind::undo_sweep));
  ASSERT_TRUE(viewer.press("c"));
  EXPECT_TRUE(receives(CommandKind::clear));
  ASSERT_TRUE(viewer.press("2"));
  EXPECT_TRUE(viewer.shows([](const QJsonObject& s) { return s["moment"].toString() == "surface"; }));
  ASSERT_TRUE(viewer.click(528, 26)) << "Navi";
  EXPECT_TRUE(viewer.shows([](const QJsonObject& s) { return s["moment"].toString() == "navigate"; }));
  ASSERT_TRUE(viewer.press("F6"));
  EXPECT_TRUE(viewer.shows([](const QJsonObject& s) { return s["views"].toInt() == 4; }));
  ASSERT_TRUE(viewer.press("bracketleft"));
  EXPECT_TRUE(
      viewer.shows([](const QJsonObject& s) { return s["surface_interval_mm"].toDouble() == 0.635; }));
}

TEST_F(WindowTest, ClearForgetsTheSurfaceInTheWindow) {
  FakeDaemon daemon(segment_);
  daemon.start_scan();
  daemon.publish_board();
  ViewerUnderTest viewer(segment_, display_);
  ASSERT_TRUE(viewer.shows([](const QJsonObject& s) { return s["triangles"].toInt() > 0; }))
      << viewer.process().standard_error();
  ASSERT_TRUE(viewer.press("c"));
  EXPECT_TRUE(viewer.shows([](const QJsonObject& s) {
    return s["points"].toInt() == 0 && s["points_drawn"].toInt() == 0 && s["triangles"].toInt() == 0;
  }));
}

/// Pixels of a colour, within a few steps, in a region given in shares of the picture.
int pixels_like(const cv::Mat& picture, const cv::Rect2d& share, const cv::Vec3b& bgr, int tolerance) {
  const cv::Rect region(static_cast<int>(share.x * picture.cols), static_cast<int>(share.y * picture.rows),
                        static_cast<int>(share.width * picture.cols),
                        static_cast<int>(share.height * picture.rows));
  cv::Mat mask;
  const auto channel = [&](int i, int sign) { return static_cast<double>(bgr[i]) + sign * tolerance; };
  cv::inRange(picture(region), cv::Scalar(channel(0, -1), channel(1, -1), channel(2, -1)),
              cv::Scalar(channel(0, 1), channel(1, 1), channel(2, 1)), mask);
  return cv::countNonZero(mask);
}

TEST_F(WindowTest, PicturesHaveTheWantedSizeAndShowWhatTheyShould) {
  FakeDaemon daemon(segment_);
  daemon.start_scan();
  daemon.publish_board();
  MovingTools tools(daemon, 10);
  TemporaryFolder folder;
  const auto script = folder.path() / "steps";
  FILE* out = std::fopen(script.c_str(), "w");
  ASSERT_NE(out, nullptr);
  std::fputs(
      "wait-for triangles 100 30\nwait 0.5\nscreenshot scan.png\ndo surface\nwait 0.5\nscreenshot "
      "surface.png\n"
      "do navi\nwait-for blank 0 30\nwait 0.5\nscreenshot navi.png\nsize 1920 1080\nwait 1\nscreenshot "
      "large.png\n",
      out);
  std::fclose(out);
  ViewerUnderTest viewer(segment_, display_,
                         {"--script", script.string(), "--pictures", folder.path().string()});
  const auto end = viewer.process().wait(90s);
  ASSERT_TRUE(end) << "the script did not end";
  ASSERT_EQ(end->code, 0) << viewer.process().standard_error();

  const cv::Rect2d views(0, 0.12, 0.7, 0.73), bar(0.5, 0, 0.5, 0.08), side(0.73, 0.12, 0.27, 0.3);
  const cv::Vec3b disclaimer(0x00, 0x9f, 0xe6), cloud(0xc9, 0xb8, 0x8f), white(255, 255, 255);
  for (const char* name : {"scan.png", "surface.png", "navi.png"}) {
    const cv::Mat picture = cv::imread((folder.path() / name).string());
    ASSERT_EQ(picture.size(), cv::Size(1280, 720)) << name << ": the window grew, something does not fit";
    EXPECT_GT(pixels_like(picture, bar, disclaimer, 8), 2'000) << name << ": not for clinical use";
  }
  const cv::Mat scan = cv::imread((folder.path() / "scan.png").string());
  const cv::Mat navi = cv::imread((folder.path() / "navi.png").string());
  EXPECT_GT(pixels_like(scan, views, cloud, 8), 3'000) << "points";
  EXPECT_LT(pixels_like(navi, views, cloud, 2), 300) << "no points while the surface is shown";
  // AngDif: white and much of it in Navigate.
  EXPECT_GT(pixels_like(navi, side, white, 4), 4'000);
  EXPECT_EQ(cv::imread((folder.path() / "large.png").string()).size(), cv::Size(1920, 1080));
}

TEST_F(WindowTest, AScriptThatCannotGoOnFailsWithItsLine) {
  TemporaryFolder folder;
  const auto script = folder.path() / "steps";
  FILE* out = std::fopen(script.c_str(), "w");
  ASSERT_NE(out, nullptr);
  std::fputs("wait 0.1\nwait-for points 5 0.5\n", out);
  std::fclose(out);
  ViewerUnderTest viewer(segment_, display_, {"--script", script.string()});
  const auto end = viewer.process().wait(30s);
  ASSERT_TRUE(end);
  EXPECT_EQ(end->code, 1);
  EXPECT_NE(viewer.process().standard_error().find("script line 2"), std::string::npos)
      << viewer.process().standard_error();
}

TEST_F(WindowTest, LeavesAPictureAndEndsAfterTheTime) {
  TemporaryFolder folder;
  const std::string file = (folder.path() / "end.png").string();
  ViewerUnderTest viewer(segment_, display_, {"--quit-after", "1", "--screenshot", file});
  const auto end = viewer.process().wait(30s);
  ASSERT_TRUE(end);
  EXPECT_EQ(end->code, 0);
  EXPECT_FALSE(cv::imread(file).empty());
}

TEST_F(WindowTest, APictureThatCannotBeWrittenIsAFailure) {
  ViewerUnderTest viewer(segment_, display_, {"--quit-after", "0.5", "--screenshot", "/nowhere/at/all.png"});
  const auto end = viewer.process().wait(30s);
  ASSERT_TRUE(end);
  EXPECT_EQ(end->code, 1);
  EXPECT_NE(viewer.process().standard_error().find("/nowhere/at/all.png"), std::string::npos);
}

TEST(ViewerProcess, WithoutADisplayItSaysHowToGoOn) {
  ChildProcess viewer({LINESCOPE_VIEWER}, {"DISPLAY=", "WAYLAND_DISPLAY=", "QT_QPA_PLATFORM="});
  const auto end = viewer.wait(20s);
  ASSERT_TRUE(end);
  EXPECT_EQ(end->code, 1);
  EXPECT_NE(viewer.standard_error().find("xvfb-run"), std::string::npos) << viewer.standard_error();
}

}  // namespace
}  // namespace linescope::testing
