// Sessions are kept and shown again without any daemon; settings last from run to run.
#include <QFile>
#include <filesystem>
#include <fstream>

#include "tests/integration/viewer/window_test.hpp"

namespace linescope::testing {
namespace {

namespace fs = std::filesystem;

QString text(const QJsonObject& shown, const char* key) {
  return shown[key].toString();
}

fs::path only_entry(const fs::path& folder) {
  const fs::directory_iterator first(folder);
  return first == fs::directory_iterator() ? fs::path() : first->path();
}

class SessionWindow : public WindowTest {
 protected:
  /// A session of the board, kept by a real key press.
  fs::path keep_one() {
    FakeDaemon daemon(segment_);
    daemon.start_scan();
    daemon.publish_board();
    daemon.writer().publish_configuration("[camera]\nsource = \"test\"\n");
    ViewerUnderTest viewer(segment_, display_, {"--sessions", sessions_.path().string()});
    EXPECT_TRUE(viewer.shows([](const QJsonObject& s) { return s["triangles"].toInt() > 100; }))
        << viewer.process().standard_error();
    EXPECT_TRUE(viewer.press("2"));
    EXPECT_TRUE(viewer.press("e"));
    EXPECT_TRUE(viewer.shows([](const QJsonObject& s) { return text(s, "evaluation").contains("too flat"); }))
        << "a board is no cylinder: " << viewer.text("evaluation");
    EXPECT_TRUE(viewer.press("F3"));
    EXPECT_TRUE(viewer.shows([](const QJsonObject& s) {
      return text(s, "notice").contains("Session saved");
    })) << viewer.text("notice");
    EXPECT_EQ(viewer.text("moment"), "surface") << "the pictures of the other moments leave no trace";
    return only_entry(sessions_.path());
  }

  TemporaryFolder sessions_;
};

TEST_F(SessionWindow, IsKeptAsAFolderAndShownAgainWithoutADaemon) {
  const fs::path kept = keep_one();
  ASSERT_FALSE(kept.empty());
  for (const char* file : {"session.toml", "surface.ply", "points.csv", "lines.csv", "evaluation.csv",
                           "configuration.toml", "calibration.yaml", "diagnostics.txt", "report.html",
                           "pictures/scan.png", "pictures/surface.png", "pictures/navigate.png"})
    EXPECT_GT(fs::file_size(kept / file), 0U) << file;

  ViewerUnderTest viewer(segment_, display_, {"--load", kept.string()});
  ASSERT_TRUE(viewer.shows([](const QJsonObject& s) {
    return text(s, "link") == "file" && s["points_drawn"].toInt() == 61 * 121 && s["triangles"].toInt() > 100;
  })) << viewer.text("notice");
  EXPECT_TRUE(viewer.shows([](const QJsonObject& s) {
    return text(s, "banner").contains("linescope-session");
  })) << viewer.text("banner");
  EXPECT_EQ(viewer.text("angle_text"), "--");
  // What the points allow goes on working: another surface.
  const int triangles = viewer.shown()["triangles"].toInt();
  ASSERT_TRUE(viewer.press("2"));
  ASSERT_TRUE(viewer.press("bracketleft"));
  EXPECT_TRUE(viewer.shows([&](const QJsonObject& s) { return s["triangles"].toInt() > triangles; }));
  ASSERT_TRUE(viewer.press("l"));
  EXPECT_TRUE(viewer.shows([](const QJsonObject& s) {
    return text(s, "link") == "searching" && s["points_drawn"].toInt() == 0 && s["triangles"].toInt() == 0;
  }));
  // ... and from the file to a daemon.
  FakeDaemon daemon(segment_);
  daemon.start_scan();
  daemon.publish_line(0);
  EXPECT_TRUE(viewer.shows([](const QJsonObject& s) { return s["points_drawn"].toInt() == 121; }));
}

TEST_F(SessionWindow, OfAMeshFileHasNoPointsToMakeItOtherwise) {
  const fs::path kept = keep_one();
  ASSERT_FALSE(kept.empty());
  ViewerUnderTest viewer(segment_, display_, {"--load", (kept / "surface.ply").string()});
  ASSERT_TRUE(viewer.shows([](const QJsonObject& s) { return s["triangles"].toInt() > 100; }))
      << viewer.text("notice");
  EXPECT_EQ(viewer.shown()["points"].toInt(), 0);
  const int triangles = viewer.shown()["triangles"].toInt();
  ASSERT_TRUE(viewer.press("bracketright"));
  EXPECT_TRUE(viewer.shows([](const QJsonObject& s) { return text(s, "notice").contains("no points"); }));
  EXPECT_EQ(viewer.shown()["triangles"].toInt(), triangles);
}

TEST_F(SessionWindow, ThatCannotBeLoadedOrKeptIsSaid) {
  ViewerUnderTest viewer(segment_, display_, {"--load", "/nowhere/session", "--sessions", "/proc/nowhere"});
  ASSERT_TRUE(viewer.shows([](const QJsonObject& s) {
    return text(s, "notice").contains("/nowhere/session");
  })) << viewer.process().standard_error();
  ASSERT_TRUE(viewer.press("F3"));
  EXPECT_TRUE(viewer.shows([](const QJsonObject& s) { return text(s, "notice").contains("cannot be made"); }))
      << viewer.text("notice");
}

TEST_F(WindowTest, RemembersItsSettings) {
  TemporaryFolder settings;
  {
    ViewerUnderTest viewer(segment_, display_, {"--interval", "2.54"}, settings.path().string());
    ASSERT_TRUE(viewer.shows([](const QJsonObject& s) { return !s.isEmpty(); }));
    ASSERT_TRUE(viewer.press("F6"));
    ASSERT_TRUE(viewer.press("n"));
    ASSERT_TRUE(
        viewer.shows([](const QJsonObject& s) { return s["layout"].toInt() == 1 && !s["smooth"].toBool(); }));
    ASSERT_TRUE(viewer.press("ctrl+q"));
    const auto end = viewer.process().wait(20s);
    ASSERT_TRUE(end);
    EXPECT_EQ(end->code, 0);
  }
  const auto again = [&](std::vector<std::string> arguments) {
    ViewerUnderTest viewer(segment_, display_, std::move(arguments), settings.path().string());
    EXPECT_TRUE(viewer.shows([](const QJsonObject& s) { return !s.isEmpty(); }));
    return viewer.shown();
  };
  const QJsonObject remembered = again({});
  EXPECT_EQ(remembered["layout"].toInt(), 1);
  EXPECT_FALSE(remembered["smooth"].toBool());
  EXPECT_EQ(remembered["wanted_interval_mm"].toDouble(), 2.54);
  EXPECT_EQ(again({"--no-settings"})["layout"].toInt(), 0);
  std::ofstream(settings.path() / "linescope" / "viewer.ini") << "[views]\nlayout=77\n[window]\nwidth=oops\n";
  EXPECT_EQ(again({})["layout"].toInt(), 0) << "what cannot be is as if it were not there";
}

}  // namespace
}  // namespace linescope::testing
