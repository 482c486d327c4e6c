// Keys and clicks into the real viewer, and what the real daemon makes of them: read back from its segment.
#include <gtest/gtest.h>

#include <QJsonObject>

#include "tests/integration/acquire/daemon_under_test.hpp"
#include "tests/integration/viewer/viewer_under_test.hpp"

namespace linescope::testing {
namespace {

using namespace std::chrono_literals;

std::string notice(const QJsonObject& shown) {
  return shown["notice"].toString().toStdString();
}

class Operator : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(display_.up()) << "Xvfb is needed: apt-get install xvfb";
    viewer_.emplace(daemon_.segment(), display_);
    reader_ = daemon_.attach();
    ASSERT_TRUE(reader_) << daemon_.process().standard_error();
    ASSERT_TRUE(viewer_->shows([](const QJsonObject& s) { return s["link"].toString() == "attached"; }, 60s))
        << viewer_->process().standard_error();
  }

  std::size_t lines() const { return whole_scan(*reader_).lines.size(); }
  /// In the segment and in the window: the key for both starts what the window shows as stopped.
  bool scanning(bool wanted) const {
    return eventually([&] { return reader_->scanning() == wanted; }, 60s) &&
           viewer_->shows([&](const QJsonObject& s) { return s["scanning"].toBool() == wanted; }, 60s);
  }
  bool lines_beyond(std::size_t count) const {
    return eventually([&] { return lines() > count; }, 60s);
  }
  bool key(const char* which) const { return viewer_->press(which); }
  bool click(const char* button) const {
    const QJsonObject place = viewer_->shown()["buttons"].toObject()[button].toObject();
    return viewer_->click(place["x"].toInt() + place["width"].toInt() / 2,
                          place["y"].toInt() + place["height"].toInt() / 2);
  }
  /// Two sweeps of some lines each, the scan stopped; lines of the first one.
  std::size_t scan_two_sweeps() const {
    EXPECT_TRUE(key("space") && scanning(true) && lines_beyond(20));
    EXPECT_TRUE(key("space") && scanning(false));
    const std::size_t first = lines();
    EXPECT_TRUE(key("space") && scanning(true) && lines_beyond(first + 20));
    EXPECT_TRUE(key("space") && scanning(false));
    return first;
  }

  VirtualDisplay display_;
  DaemonUnderTest daemon_{{}};
  std::optional<ViewerUnderTest> viewer_;
  std::optional<SegmentReader> reader_;
};

TEST_F(Operator, SpaceStartsAndStopsTheDaemonsScan) {
  EXPECT_FALSE(reader_->scanning());
  EXPECT_EQ(lines(), 0u);
  ASSERT_TRUE(key("space"));
  ASSERT_TRUE(scanning(true));
  ASSERT_TRUE(lines_beyond(20));
  ASSERT_TRUE(key("space"));
  ASSERT_TRUE(scanning(false));
  const std::size_t stopped_at = lines();
  EXPECT_TRUE(viewer_->shows(
      [&](const QJsonObject& s) { return s["lines"].toDouble() == static_cast<double>(stopped_at); }));
  std::this_thread::sleep_for(300ms);
  EXPECT_EQ(lines(), stopped_at) << "nothing is added to a stopped scan";
}

TEST_F(Operator, BackspaceTakesTheLastSweepBackAndOnlyThat) {
  const std::size_t first = scan_two_sweeps();
  ASSERT_TRUE(key("BackSpace"));
  EXPECT_TRUE(eventually([&] { return lines() == first; }, 60s)) << lines() << " instead of " << first;
  EXPECT_TRUE(viewer_->shows(
      [&](const QJsonObject& s) { return s["lines"].toDouble() == static_cast<double>(first); }));
  ASSERT_TRUE(key("BackSpace"));
  EXPECT_TRUE(eventually([&] { return lines() == 0; }, 60s));
  ASSERT_TRUE(key("BackSpace"));
  EXPECT_TRUE(viewer_->shows([](const QJsonObject& s) {
    return notice(s).find("there is no sweep to take back") != std::string::npos;
  })) << viewer_->text("notice");
}

TEST_F(Operator, TheButtonsDoTheSameWithTheMouse) {
  ASSERT_TRUE(click("scan"));
  ASSERT_TRUE(scanning(true));
  ASSERT_TRUE(lines_beyond(20));
  ASSERT_TRUE(click("scan"));
  ASSERT_TRUE(scanning(false));
  ASSERT_TRUE(click("surface"));
  ASSERT_TRUE(viewer_->shows([](const QJsonObject& s) { return s["moment"].toString() == "surface"; }));
  ASSERT_TRUE(click("clear"));
  EXPECT_TRUE(eventually([&] { return lines() == 0; }, 60s));
  EXPECT_TRUE(viewer_->shows(
      [](const QJsonObject& s) { return s["points"].toDouble() == 0 && s["triangles"].toDouble() == 0; }));
}

TEST_F(Operator, TheScanGoesOnWhenTheWindowIsKilled) {
  ASSERT_TRUE(key("space"));
  ASSERT_TRUE(lines_beyond(20));
  viewer_->process().send(SIGKILL);
  const std::size_t at_its_death = lines();
  EXPECT_TRUE(lines_beyond(at_its_death + 20));
}

}  // namespace
}  // namespace linescope::testing
