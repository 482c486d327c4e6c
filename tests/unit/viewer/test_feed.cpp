// The acquisition thread against a real segment: attaching, losing, keeping, forgetting.
#include <gtest/gtest.h>

#include <cmath>

#include "common/units.hpp"
#include "tests/support/child_process.hpp"
#include "tests/unit/viewer/fake_daemon.hpp"
#include "viewer/navigation_worker.hpp"
#include "viewer/segment_feed.hpp"
#include "viewer/surface_worker.hpp"

namespace linescope::testing {
namespace {

using namespace std::chrono_literals;

/// Feed with everything it said.
class FeedTest : public ::testing::Test {
 protected:
  void open(HeldIn held_in = HeldIn::object) {
    feed_ = std::make_unique<SegmentFeed>(
        FeedOptions{.segment = segment_, .held_in = held_in},
        FeedSinks{.live = [this](std::shared_ptr<const LiveView> v) { live_.put(std::move(v)); },
                  .lines = [this](const LineNews& n) { news_.put(n); }});
  }
  ~FeedTest() override { feed_.reset(); }

  bool comes(const std::function<bool(const LiveView&)>& what) {
    return eventually([&] { return what(*live_.get()); }, 10s);
  }
  bool link(LinkState state) {
    return comes([&](const LiveView& v) { return v.link.state == state; });
  }
  /// Follows forget and lines as the scene does.
  std::size_t lines_held() {
    for (const LineNews& n : news_.take()) {
      if (n.forget) held_.clear();
      held_.insert(held_.end(), n.lines.begin(), n.lines.end());
    }
    return held_.size();
  }
  bool holds(std::size_t lines) {
    return eventually([&] { return lines_held() == lines; }, 10s);
  }

  const std::string segment_ = unique_segment();
  Latest<LiveView> live_;
  Inbox<LineNews> news_;
  HeldLines held_;
  std::unique_ptr<SegmentFeed> feed_;
};

TEST_F(FeedTest, AttachesToADaemonThatComesLater) {
  open();
  ASSERT_TRUE(
      comes([](const LiveView& v) { return v.link.text.find("linescope-acquire") != std::string::npos; }));
  EXPECT_EQ(live_.get()->link.state, LinkState::searching);
  FakeDaemon daemon(segment_);
  EXPECT_TRUE(link(LinkState::attached));
  EXPECT_EQ(live_.get()->link.daemon, "fake daemon");
}

TEST_F(FeedTest, LinesAreHeldInTheObjectsFrame) {
  FakeDaemon daemon(segment_);
  daemon.start_scan();
  daemon.publish_line(3.5);
  open();
  ASSERT_TRUE(holds(1));
  for (const SurfacePoint& p : held_[0]->points) {
    EXPECT_NEAR(p.position.y(), 3.5, 1e-4);  // float in world coordinates of 120 mm
    EXPECT_NEAR(p.position.z(), 0.0, 1e-4);
  }
  // The camera: 80 mm above the board in the fake, plus where the calibration puts it on the endoscope.
  EXPECT_NEAR((held_[0]->seen_from - Eigen::Vector3d(0, 0, 80)).norm(), 0,
              1e-6 + daemon.calibration().endoscope_from_camera.translation().norm());
}

TEST_F(FeedTest, ALineWithoutAGoodObjectPoseIsCountedAndNotPlaced) {
  FakeDaemon daemon(segment_);
  daemon.start_scan();
  daemon.publish_line(0, ToolState::out_of_view);
  daemon.publish_line(1, ToolState::ok);
  open();
  ASSERT_TRUE(comes([](const LiveView& v) { return v.scan.lines == 1; }));
  EXPECT_EQ(live_.get()->scan.lines_unplaced, 1u);
  EXPECT_EQ(live_.get()->scan.unplaced_because, ToolState::out_of_view);
  EXPECT_EQ(lines_held(), 1u);
}

TEST_F(FeedTest, HeldInTheWorldTheObjectIsNotAsked) {
  FakeDaemon daemon(segment_);
  daemon.start_scan();
  daemon.publish_line(0, ToolState::never_seen);
  open(HeldIn::world);
  ASSERT_TRUE(holds(1));
  const Eigen::Vector3d middle = FakeDaemon::world_from_object().translation();
  EXPECT_NEAR((held_[0]->points[60].position.cast<double>() - middle).norm(), 0, 1e-4);
}

TEST_F(FeedTest, TheSurfaceOutlivesTheDaemonAndGrowsWithTheNextOne) {
  auto daemon = std::make_unique<FakeDaemon>(segment_);
  daemon->start_scan();
  daemon->publish_board();
  open();
  ASSERT_TRUE(holds(61));
  daemon.reset();
  ASSERT_TRUE(link(LinkState::ended));
  daemon = std::make_unique<FakeDaemon>(segment_);
  ASSERT_TRUE(link(LinkState::attached));
  EXPECT_EQ(lines_held(), 61u);
  daemon->start_scan();
  daemon->publish_line(9);
  EXPECT_TRUE(holds(62));
  EXPECT_TRUE(comes([](const LiveView& v) { return v.scan.lines == 62; }));
}

TEST_F(FeedTest, UndoTakesBackThePresentDaemonsLinesOnly) {
  auto daemon = std::make_unique<FakeDaemon>(segment_);
  daemon->start_scan();
  daemon->publish_line(0);
  open();
  ASSERT_TRUE(holds(1));
  daemon.reset();
  ASSERT_TRUE(link(LinkState::ended));
  daemon = std::make_unique<FakeDaemon>(segment_);
  daemon->start_scan();
  daemon->publish_line(1);
  daemon->publish_line(2);
  ASSERT_TRUE(holds(3));
  daemon->writer().undo_to(1);
  EXPECT_TRUE(holds(2));
}

TEST_F(FeedTest, ClearedByTheDaemonIsForgottenHere) {
  FakeDaemon daemon(segment_);
  daemon.start_scan();
  daemon.publish_board();
  open();
  ASSERT_TRUE(holds(61));
  daemon.writer().begin_scan(monotonic_now(), ScanCause::cleared);
  EXPECT_TRUE(holds(0));
  EXPECT_TRUE(comes([](const LiveView& v) { return v.scan.points == 0; }));
}

TEST_F(FeedTest, ClearWorksWithoutADaemon) {
  auto daemon = std::make_unique<FakeDaemon>(segment_);
  daemon->start_scan();
  daemon->publish_board();
  open();
  ASSERT_TRUE(holds(61));
  daemon.reset();
  ASSERT_TRUE(link(LinkState::ended));
  feed_->forget_scan();
  EXPECT_TRUE(holds(0));
}

TEST_F(FeedTest, ToolsOfADeadDaemonAreDisconnected) {
  auto daemon = std::make_unique<FakeDaemon>(segment_);
  daemon->publish_tools(0);
  open();
  ASSERT_TRUE(comes([](const LiveView& v) { return v.tool(ToolRole::harvester).acquired != 0; }));
  daemon.reset();
  EXPECT_TRUE(
      comes([](const LiveView& v) { return v.tool(ToolRole::harvester).state == ToolState::disconnected; }));
}

TEST_F(FeedTest, CommandsReachTheDaemonAndWithoutOneAreRefusedInWords) {
  open();
  ASSERT_TRUE(link(LinkState::searching));
  feed_->courier().order({.kind = CommandKind::start, .number = 0, .text = {}});
  std::vector<Notice> notices;
  ASSERT_TRUE(eventually([&] { return !(notices = feed_->courier().take_notices()).empty(); }, 10s));
  EXPECT_EQ(notices[0].kind, Notice::Kind::refusal);
  EXPECT_NE(notices[0].text.find("linescope-acquire"), std::string::npos);
  FakeDaemon daemon(segment_);
  ASSERT_TRUE(link(LinkState::attached));
  feed_->courier().order({.kind = CommandKind::start, .number = 0, .text = {}});
  std::vector<CommandKind> received;
  ASSERT_TRUE(eventually([&] { return !(received = daemon.poll_commands()).empty(); }, 10s));
  EXPECT_EQ(received, std::vector{CommandKind::start});
  ASSERT_TRUE(eventually([&] { return !(notices = feed_->courier().take_notices()).empty(); }, 10s));
  EXPECT_EQ(notices[0].kind, Notice::Kind::information);
}

TEST_F(FeedTest, FromLinesAndPosesToTheAngle) {
  FakeDaemon daemon(segment_);
  daemon.start_scan();
  daemon.publish_board();
  Latest<NavigationView> answer;
  NavigationWorker navigator(NormalChoice::robust,
                             [&](std::shared_ptr<const NavigationView> v) { answer.put(std::move(v)); });
  open();
  ASSERT_TRUE(holds(61));
  navigator.add({.forget = false, .lines = held_});
  const double tilt = radians_from_degrees(10);
  const bool good = eventually(
      [&] {
        daemon.publish_tools(tilt);
        navigator.set_poses(live_.get());
        return answer.get()->good;
      },
      10s);
  ASSERT_TRUE(good) << answer.get()->reason;
  // The board has no noise: what is left is the floats of the points over a patch of some millimetres.
  EXPECT_NEAR(degrees_from_radians(answer.get()->angle), 10.0, 0.05);
  EXPECT_NEAR(answer.get()->distance, 0.0, 0.01);
}

TEST(SurfaceWorkerTest, MakesTheSurfaceAnewWithOtherOptionsAndRefusesBadOnes) {
  HeldLines lines;
  for (int y = -30; y <= 30; ++y) {
    auto line = std::make_shared<HeldLine>();
    line->seen_from = {0, 0, 80};
    for (int x = -60; x <= 60; ++x)
      line->points.push_back({{0.1F * static_cast<float>(x), 0.2F * static_cast<float>(y), 0}, 100, 0.05F});
    lines.push_back(line);
  }
  Latest<SurfaceView> surface;
  MesherOptions options;
  options.method = MeshMethod::proposed_cubes;
  SurfaceWorker worker(options, [&](std::shared_ptr<const SurfaceView> v) { surface.put(std::move(v)); });
  worker.add({.forget = false, .lines = lines});
  ASSERT_TRUE(eventually(
      [&] { return surface.get()->lines == 61 && surface.get()->mesh && !surface.get()->mesh->empty(); },
      10s));
  const std::size_t coarse = surface.get()->grid->size();
  options.interval = 0.635;
  worker.set_options(options);
  ASSERT_TRUE(eventually([&] { return surface.get()->interval == 0.635; }, 10s));
  EXPECT_GT(surface.get()->grid->size(), 2 * coarse);
  options.interval = -1;
  worker.set_options(options);
  ASSERT_TRUE(eventually([&] { return !surface.get()->fault.empty(); }, 10s));
  EXPECT_EQ(surface.get()->interval, 0.635);
  worker.add({.forget = true, .lines = {}});
  EXPECT_TRUE(eventually([&] { return surface.get()->mesh->empty(); }, 10s));
}

TEST(SurfaceWorkerTest, AChangeThatIsGivenUpLeavesTheSurfaceAsItWas) {
  HeldLines lines;
  for (int y = 0; y < 400; ++y) {
    auto line = std::make_shared<HeldLine>();
    line->seen_from = {0, 0, 80};
    line->serial = static_cast<std::uint64_t>(y);
    for (int x = 0; x < 2'000; ++x)
      line->points.push_back({{0.01F * static_cast<float>(x), 0.05F * static_cast<float>(y), 0}, 100, 0.05F});
    lines.push_back(line);
  }
  Latest<SurfaceView> surface;
  MesherOptions options;
  options.method = MeshMethod::proposed_cubes;
  SurfaceWorker worker(options, [&](std::shared_ptr<const SurfaceView> v) { surface.put(std::move(v)); });
  worker.add({.forget = false, .lines = lines});
  ASSERT_TRUE(eventually([&] { return surface.get()->lines == 400; }));
  const std::uint64_t version = surface.get()->version;
  options.method = MeshMethod::implicit;
  options.interval = 0.635;
  worker.set_options(options);
  while (!worker.changing() && surface.get()->version == version) std::this_thread::yield();
  worker.give_up_change();
  ASSERT_TRUE(eventually([&] { return surface.get()->version > version && !worker.changing(); }));
  EXPECT_EQ(surface.get()->interval, 1.27);
  EXPECT_EQ(surface.get()->method, name(MeshMethod::proposed_cubes));
  // The next change is not given up with it.
  worker.set_options(options);
  EXPECT_TRUE(eventually([&] { return surface.get()->interval == 0.635; }));
}

}  // namespace
}  // namespace linescope::testing
