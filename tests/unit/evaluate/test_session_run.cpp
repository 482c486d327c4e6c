// Sessions on the twin through the daemon's own run.
#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "tools/evaluate/deviations.hpp"
#include "tools/evaluate/setups.hpp"
#include "tools/evaluate/virtual_session.hpp"

namespace linescope::evaluate {
namespace {

twin::TwinOptions plane(const char* noise, double seconds = 0.5) {
  twin::TwinOptions options = sweeping(system_ii(3), 15, seconds);
  EXPECT_TRUE(twin::apply_noise_preset(options, noise));
  options.phantom = phantom("plane");
  return options;
}

Session acquired(const twin::TwinOptions& options) {
  const auto session = VirtualSession::render(options);
  EXPECT_TRUE(session) << session.error().message;
  auto scan = session->acquire(better_session());
  EXPECT_TRUE(scan) << scan.error().message;
  return std::move(*scan);
}

bool same(const Session& a, const Session& b) {
  if (a.lines.size() != b.lines.size()) return false;
  for (std::size_t i = 0; i < a.lines.size(); ++i) {
    if (a.lines[i]->time != b.lines[i]->time || a.lines[i]->points.size() != b.lines[i]->points.size())
      return false;
    for (std::size_t k = 0; k < a.lines[i]->points.size(); ++k)
      if (a.lines[i]->points[k].position != b.lines[i]->points[k].position) return false;
  }
  return true;
}

// Every picture of half a second becomes a line; 8 bits and the wire's 32-bit floats limit the points.
TEST(SessionRun, WithoutNoiseThePhantomComesBack) {
  const twin::TwinOptions options = plane("ideal");
  const auto session = VirtualSession::render(options);
  ASSERT_TRUE(session);
  const Session scan = acquired(options);
  EXPECT_EQ(session->pictures(), 15u);
  EXPECT_GE(scan.lines.size(), 14u);
  const Deviations d = deviations_of(scan.lines, session->truth());
  EXPECT_GT(d.count, 14u * 100);
  EXPECT_LT(d.rms, 0.01);
  EXPECT_GT(d.rms, 1e-5) << "no picture was measured";
}

TEST(SessionRun, SameSeedSamePoints) {
  EXPECT_TRUE(same(acquired(plane("thesis")), acquired(plane("thesis"))));
}

TEST(SessionRun, OtherSeedOtherPoints) {
  twin::TwinOptions other = plane("thesis");
  other.seed = 4;
  EXPECT_FALSE(same(acquired(plane("thesis")), acquired(other)));
}

TEST(SessionRun, TwoAtTheSameTimeDoNotMeet) {
  const Session alone = acquired(plane("thesis", 0.3));
  Session left, right;
  std::thread first([&] { left = acquired(plane("thesis", 0.3)); });
  std::thread second([&] { right = acquired(plane("thesis", 0.3)); });
  first.join();
  second.join();
  EXPECT_TRUE(same(left, alone));
  EXPECT_TRUE(same(right, alone));
}

TEST(SessionRun, CountsWhatBecameOfThePictures) {
  const Session scan = acquired(plane("thesis", 0.3));
  EXPECT_EQ(scan.count(Counter::frames_received), 9u);
}

TEST(SessionRun, PosesOfAllThreeToolsAreThere) {
  const Session scan = acquired(plane("thesis", 0.3));
  for (const auto& poses : scan.poses) {
    // 240 Hz without a gap, at least until the last line was placed.
    ASSERT_GT(poses.size(), 60u);
    EXPECT_GE(poses.back().time, scan.lines.back()->time);
    for (std::size_t i = 1; i < poses.size(); ++i)
      EXPECT_NEAR(double(poses[i].time - poses[i - 1].time), 1e9 / 240, 1e5) << i;
  }
}

TEST(VirtualSession, NeedsAnEnd) {
  twin::TwinOptions endless = plane("thesis");
  endless.duration = 0;
  EXPECT_EQ(VirtualSession::render(endless).error().code, ErrorCode::usage);
}

TEST(VirtualSession, KnowsThePhantomsFrame) {
  const auto session = VirtualSession::without_pictures(plane("ideal"));
  ASSERT_TRUE(session);
  const Eigen::Vector3d above(1, 2, 3);
  const Eigen::Vector3d in_object = session->phantom_from_object().inverse() * above;
  EXPECT_NEAR(session->truth().distance(in_object), 3, 1e-9) << "the plane is z = 0";
}

// With 6 mm, as printed for system II, the printed camera I does not see the line at 10 mm.
TEST(Setups, SystemOneNeedsAShorterBaselineThanSystemTwo) {
  twin::TwinOptions options = sweeping(system_i(1), 10, 1);
  EXPECT_TRUE(validate(options));
  options.instrument.baseline_mm = 6.0;
  const auto valid = validate(options);
  ASSERT_FALSE(valid);
  EXPECT_NE(valid.error().message.find("out of the picture"), std::string::npos) << valid.error().message;
}

}  // namespace
}  // namespace linescope::evaluate
