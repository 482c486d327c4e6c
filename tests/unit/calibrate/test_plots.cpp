// Pictures of a calibration: points lie where the axes say, colours mean what the legend says, and every step
// has some.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <opencv2/core.hpp>

#include "tests/unit/calibrate/tool_motion.hpp"
#include "tools/calibrate/chart.hpp"
#include "tools/calibrate/harvester_step.hpp"

namespace linescope::calibrate {
namespace {

const cv::Scalar kBlue(180, 110, 30), kRed(40, 40, 205);

/// Middles of the spots of about that colour, from left to right.
std::vector<cv::Point2d> spots(const cv::Mat& picture, const cv::Scalar& colour) {
  cv::Mat found;
  cv::inRange(picture, colour - cv::Scalar::all(6), colour + cv::Scalar::all(6), found);
  std::vector<cv::Point2d> middles;
  for (int x = 0, begin = -1; x < found.cols; ++x) {
    const bool here = cv::countNonZero(found.col(x)) > 0;
    if (here && begin < 0) begin = x;
    if (here || begin < 0) continue;
    double sum = 0, count = 0;
    for (int y = 0; y < found.rows; ++y) {
      const int hits = cv::countNonZero(found.row(y).colRange(begin, x));
      sum += static_cast<double>(y) * hits, count += hits;
    }
    middles.emplace_back(0.5 * (begin + x - 1), sum / count);
    begin = -1;
  }
  return middles;
}

TEST(Chart, PointsLieWhereTheAxesSay) {
  Chart chart{.title = "t", .across = "x (mm)", .up = "y (mm)"};
  chart.series = {{.name = "", .points = {{0, 0}, {2, 4}, {10, 2}}}};
  const cv::Mat picture = drawn(chart);
  const auto dots = spots(picture, kBlue);
  ASSERT_EQ(dots.size(), 3u);
  EXPECT_NEAR((dots[1].x - dots[0].x) / (dots[2].x - dots[0].x), 0.2, 0.01);
  EXPECT_NEAR((dots[0].y - dots[2].y) / (dots[0].y - dots[1].y), 0.5, 0.02);  // up is up
}

TEST(Chart, SameScaleMakesACircleRound) {
  Chart chart{.title = "t", .across = "x (mm)", .up = "y (mm)"};
  chart.series = {{.name = "", .points = {{-1, 0}, {0, 1}, {1, 0}}}};
  chart.same_scale = true;
  const auto dots = spots(drawn(chart), kBlue);
  ASSERT_EQ(dots.size(), 3u);
  EXPECT_NEAR(dots[1].x - dots[0].x, dots[0].y - dots[1].y, 2);
}

TEST(Chart, ValuesBecomeColours) {
  Chart chart{.title = "t", .across = "x", .up = "y"};
  chart.series = {{.name = "", .points = {{0, 0}, {1, 0}}, .values = {-1, 1}}};
  chart.scale = ColourScale{"mm", -1, 1};
  const cv::Mat picture = drawn(chart);
  // Beside the dots the scale on the right has the same colours at its ends.
  const auto low = spots(picture, {190, 90, 20}), high = spots(picture, {30, 40, 200});
  ASSERT_EQ(low.size(), 2u);
  ASSERT_EQ(high.size(), 2u);
  EXPECT_LT(low[0].x, high[0].x);
  EXPECT_GT(low[1].y, high[1].y);
}

TEST(Chart, NothingToShowIsNoFailure) {
  Chart chart{.title = "t", .across = "x", .up = "y"};
  EXPECT_EQ(drawn(chart).rows, chart.height);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  chart.series = {{.name = "", .points = {{nan, 1}, {1, nan}}}};
  EXPECT_TRUE(spots(drawn(chart), kBlue).empty());
  chart.series = {{.name = "", .points = {{3, 3}}}};  // of no extent
  EXPECT_EQ(spots(drawn(chart), kBlue).size(), 1u);
  EXPECT_GT(page({chart, chart}).rows, 2 * chart.height);
}

bool white(const cv::Mat& part) {
  cv::Mat ink;
  cv::inRange(part, cv::Scalar::all(0), cv::Scalar::all(200), ink);
  return cv::countNonZero(ink) == 0;
}

TEST(Chart, ALabelLongerThanItsAxisLeavesTheLinesAboveFree) {
  Chart chart{.across = "x", .up = "a label that is a great deal longer than its axis is high"};
  chart.series = {{.name = "", .points = {{0, 0}, {1, 1}}}};
  chart.height = 180;
  EXPECT_TRUE(white(drawn(chart).rowRange(0, 42)));
}

TEST(Chart, EveryDrawingSaysWhatItIsNotForHoweverNarrow) {
  for (const int width : {160, 320, 820}) {
    const cv::Mat signed_one = with_foot(cv::Mat(50, width, CV_8UC3, cv::Scalar::all(255)));
    ASSERT_EQ(signed_one.size(), cv::Size(width, 74));
    EXPECT_FALSE(white(signed_one.rowRange(50, 74))) << width;
    EXPECT_TRUE(white(signed_one.colRange(width - 2, width))) << width << ": cut off";
  }
}

Session session_of(const ToolPoses& poses) {
  Session session;
  for (const TimedToolPose& pose : poses) {
    PoseSample sample;
    sample.time = pose.time;
    sample.state = ToolState::ok;
    sample.world_from_sensor = renamed<World, Sensor>(pose.fixture_from_tool);
    session.poses[2].push_back(sample);
  }
  return session;
}

std::vector<Plot> plots_of(ToolMotion motion, const ToolPoses& poses) {
  HarvesterStep step;
  step.options().motion = motion;
  const auto outcome = step.run(session_of(poses), {}, {});
  EXPECT_TRUE(outcome) << outcome.error().message;
  return outcome ? outcome->plots : std::vector<Plot>{};
}

/// Pixels in the colour of what was left out, in the chart below.
int red_over_time(const cv::Mat& picture) {
  cv::Mat red;
  cv::inRange(picture.rowRange(480, picture.rows), kRed, kRed, red);
  return cv::countNonZero(red);
}

TEST(HarvesterPlots, EveryMotionHasItsOwnAndOutliersAreRed) {
  const PoseErrors quiet{0.02, 0.0002, 11};
  ToolPoses poses = pivoting(600, quiet);
  const auto clean = plots_of(ToolMotion::pivot, poses);
  ASSERT_EQ(clean.size(), 1u);
  EXPECT_EQ(clean[0].name, "harvester-pivot");
  for (std::size_t i = 200; i < 210; ++i)
    poses[i].fixture_from_tool = {poses[i].fixture_from_tool.rotation(),
                                  poses[i].fixture_from_tool.translation() + Eigen::Vector3d(0, 3, 0)};
  const auto slipped = plots_of(ToolMotion::pivot, poses);
  ASSERT_EQ(slipped.size(), 1u);
  // In both the legend's red square; red dots over time only where the tip slipped.
  EXPECT_GT(red_over_time(slipped[0].picture), red_over_time(clean[0].picture) + 10);
  ASSERT_EQ(plots_of(ToolMotion::spin, spinning(600, quiet)).size(), 1u);
}

}  // namespace
}  // namespace linescope::calibrate
