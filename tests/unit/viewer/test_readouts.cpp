// When a number may be on the screen, and what is there instead.
#include <gtest/gtest.h>

#include <limits>

#include "common/units.hpp"
#include "viewer/readouts.hpp"

namespace linescope {
namespace {

constexpr Nanoseconds kNow = 1000 * kSecond;

struct Good {
  LiveView live;
  NavigationView navigation;

  Good() {
    live.time = kNow;
    live.link.state = LinkState::attached;
    live.link.heartbeat = kNow;
    live.calibration_known = true;
    for (ToolView& tool : live.tools) {
      tool.station = 0;
      tool.state = ToolState::ok;
      tool.acquired = kNow - 4 * kMillisecond;
    }
    navigation.asked = navigation.good = true;
    navigation.harvester_time = navigation.object_time = kNow - 4 * kMillisecond;
    navigation.angle = radians_from_degrees(12.34);
    navigation.angle_low = radians_from_degrees(11.04);
    navigation.angle_high = radians_from_degrees(13.96);
    navigation.distance = 1.26;
  }
  ViewState state() const {
    ViewState s;
    s.live = std::make_shared<const LiveView>(live);
    s.navigation = std::make_shared<const NavigationView>(navigation);
    return s;
  }
  AngleReadout readout(Nanoseconds now = kNow) const {
    Guidance guidance(guidance_options({}));
    return angle_readout(state(), now, guidance);
  }
  void expect_blank(const std::string& reason, Nanoseconds now = kNow) const {
    const AngleReadout r = readout(now);
    for (const Readout& part : {r.angle, r.interval, r.distance, r.depth}) {
      EXPECT_EQ(part.text, kBlank);
      EXPECT_NE(part.reason.find(reason), std::string::npos) << "reason: " << part.reason;
    }
    EXPECT_FALSE(r.in_tolerance);
  }
};

TEST(AngleReadout, AGoodChainShowsNumbers) {
  const AngleReadout r = Good().readout();
  EXPECT_EQ(r.angle.text, "12.3°");
  EXPECT_EQ(r.interval.text, "11.0 – 14.0°");
  EXPECT_EQ(r.distance.text, "1.3 mm");
  EXPECT_EQ(r.pose_time, kNow - 4 * kMillisecond);
  EXPECT_FALSE(r.in_tolerance);
}

TEST(AngleReadout, ToleranceNeedsAngleAndDistance) {
  Good g;
  g.navigation.angle = radians_from_degrees(2.9);
  g.navigation.distance = 0.9;
  EXPECT_TRUE(g.readout().in_tolerance);
  g.navigation.distance = -1.1;
  EXPECT_FALSE(g.readout().in_tolerance);
}

TEST(AngleReadout, AnyBadToolOfTheChainBlanksWithItsReason) {
  for (int state = 1; state <= static_cast<int>(ToolState::never_seen); ++state) {
    for (const ToolRole role : {ToolRole::harvester, ToolRole::object}) {
      Good g;
      g.live.tool(role).state = static_cast<ToolState>(state);
      g.live.tool(role).reason = "metal near by";
      g.expect_blank("metal near by");
      g.expect_blank(std::string(name(static_cast<ToolState>(state))));
    }
  }
}

TEST(AngleReadout, TheEndoscopeIsNotPartOfTheChain) {
  Good g;
  g.live.tool(ToolRole::endoscope).state = ToolState::disconnected;
  EXPECT_FALSE(g.readout().angle.blank());
}

TEST(AngleReadout, TheObjectIsNotNeededWhereTheSurfaceIsHeldInTheWorld) {
  Good g;
  g.live.held_in = HeldIn::world;
  g.live.tool(ToolRole::object).state = ToolState::never_seen;
  EXPECT_FALSE(g.readout().angle.blank());
}

TEST(AngleReadout, AgesWithoutAnybodysHelpBeforeTheFifthOfASecondIsOver) {
  const Good g;  // every thread hangs: nothing changes but the time
  EXPECT_FALSE(g.readout(kNow + 100 * kMillisecond).angle.blank());
  // One display tick (33 ms) before 0.2 s it must be blank, so that the screen is blank in time.
  g.expect_blank("", kNow - 4 * kMillisecond + kStaleAfter - 33 * kMillisecond);
}

TEST(AngleReadout, EveryStateOfTheLinkButAttachedBlanks) {
  for (const LinkState state :
       {LinkState::searching, LinkState::silent, LinkState::ended, LinkState::refused}) {
    Good g;
    g.live.link.state = state;
    g.live.link.text = "the daemon is gone";
    g.expect_blank("the daemon is gone");
  }
}

TEST(AngleReadout, AnEstimateWithAReasonIsBlank) {
  Good g;
  g.navigation.good = false;
  g.navigation.reason = "not enough lines here";
  g.expect_blank("not enough lines here");
}

TEST(AngleReadout, WithoutACalibrationThereIsNoTip) {
  Good g;
  g.live.calibration_known = false;
  g.expect_blank("calibration");
}

TEST(AngleReadout, AMethodWithoutAnIntervalBlanksTheIntervalOnly) {
  Good g;
  g.navigation.angle_low = g.navigation.angle_high = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(g.readout().interval.blank());
  EXPECT_FALSE(g.readout().angle.blank());
}

TEST(Banner, SaysTheWorstFirstAndWhatToDo) {
  Good g;
  EXPECT_TRUE(banner(g.live, kNow).text.empty());
  g.live.tool(ToolRole::harvester).state = ToolState::disconnected;
  EXPECT_NE(banner(g.live, kNow).text.find("Harvester"), std::string::npos);
  g.live.scan.full = true;
  EXPECT_NE(banner(g.live, kNow).text.find("full"), std::string::npos);
  g.live.link.state = LinkState::silent;
  const Banner silent = banner(g.live, kNow);
  EXPECT_NE(silent.text.find("does not answer"), std::string::npos);
  EXPECT_NE(silent.advice.find("linescope-acquire"), std::string::npos);
  EXPECT_EQ(silent.mood, Mood::bad);
}

TEST(Banner, WhenEveryToolIsLateItIsNoCable) {
  const Good g;
  EXPECT_EQ(banner(g.live, kNow + kSecond).text, "No fresh pose of any tool");
  Good one = g;
  one.live.tool(ToolRole::harvester).acquired = kNow - kSecond;
  EXPECT_EQ(banner(one.live, kNow).text, "Harvester: stale");
}

TEST(CameraStatus, PicturesOfLongAgoAreNotLive) {
  Good g;
  g.live.camera.state = ToolState::ok;
  auto picture = std::make_shared<CameraPicture>();
  picture->time = kNow - 3 * kSecond;
  g.live.picture = picture;
  const StatusLine line = camera_status(g.live, kNow);
  EXPECT_EQ(line.word, "stale");
  EXPECT_EQ(line.detail, "newest picture is 3.0 s old");
  EXPECT_EQ(line.mood, Mood::bad);
}

TEST(CameraStatus, WhatToDoWithTheLaserComesFirst) {
  Good g;
  g.live.camera.state = ToolState::ok;
  g.live.camera.rate_hz = 30;
  g.live.camera.reason = "line quality 0.83, 2 % burnt out";
  EXPECT_EQ(camera_status(g.live, kNow).detail, "30 Hz · line quality 0.83");
  g.live.camera.reason += "; lower the laser: the exposure is at its shortest";
  const StatusLine line = camera_status(g.live, kNow);
  EXPECT_EQ(line.detail, "lower the laser: the exposure is at its shortest");
  EXPECT_EQ(line.mood, Mood::caution);
}

TEST(Banner, TellsOfLinesThatAreNotDrawn) {
  Good g;
  g.live.scan.lines_unplaced = 1234;
  g.live.scan.unplaced_because = ToolState::never_seen;
  g.live.tool(ToolRole::object).state = ToolState::never_seen;
  const Banner b = banner(g.live, kNow);
  EXPECT_NE(b.text.find("1,234 lines"), std::string::npos);
  EXPECT_NE(b.advice.find("--hold-in world"), std::string::npos);
}

TEST(GapReadout, IsBlankWithoutARecentLine) {
  Good g;
  EXPECT_TRUE(gap_readout(g.live, kNow).blank());
  g.live.scan.newest.time = kNow - 30 * kMillisecond;
  g.live.scan.newest.gap = 14.26;
  EXPECT_EQ(gap_readout(g.live, kNow).text, "14.3 mm");
  g.live.time = kNow + kSecond;
  EXPECT_NE(gap_readout(g.live, kNow + kSecond).reason.find("1.0 s ago"), std::string::npos);
}

TEST(Texts, NumbersAndAges) {
  EXPECT_EQ(grouped(7), "7");
  EXPECT_EQ(grouped(999), "999");
  EXPECT_EQ(grouped(1'000), "1,000");
  EXPECT_EQ(grouped(12'345'678), "12,345,678");
  EXPECT_EQ(age_text(0, kNow), "");
  EXPECT_EQ(age_text(kNow - 400 * kMillisecond, kNow), "0.4 s");
  EXPECT_EQ(age_text(kNow - 180 * kSecond, kNow), "3 min");
}

}  // namespace
}  // namespace linescope
