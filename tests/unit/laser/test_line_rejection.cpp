// Each reason for having no point, and who wins where there are two candidates.
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tests/unit/laser/line_scene.hpp"

namespace linescope {
namespace {

using testing::LineScene;
using testing::total;
using testing::wave;

ExtractedLine extract(const cv::Mat& picture, const LineExtractorOptions& options = {}) {
  LineExtractor extractor(options);
  const ExtractedLine line = extractor.extract(picture);
  // The promise behind all of these: every profile is a sample or counted once.
  EXPECT_EQ(line.samples.size() + total(line.no_point), static_cast<std::size_t>(line.profiles()));
  return line;
}

LineScene one_line() {
  LineScene scene;
  scene.noise = 1;
  scene.stripes.push_back({wave(80, 10, 150)});
  return scene;
}

TEST(Rejection, NamesAreDistinctAndPlain) {
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < kNoPointReasons; ++i) names.push_back(name(static_cast<NoPoint>(i)));
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::unique(names.begin(), names.end()), names.end());
  EXPECT_EQ(std::count(names.begin(), names.end(), "unknown"), 0);
}

TEST(Rejection, AWhiteStreakHasTheWrongColour) {
  cv::Mat picture(160, 200, CV_8UC3, cv::Scalar(30, 40, 50));
  cv::line(picture, {0, 80}, {199, 90}, cv::Scalar(110, 140, 180), 3);
  const ExtractedLine line = extract(picture);
  EXPECT_TRUE(line.samples.empty());
  EXPECT_EQ(line.count(NoPoint::wrong_colour), 200U);
}

TEST(Rejection, AGreenishLineInBlueLightIsFoundByItsRise) {
  // Colour excess is nowhere positive, but green rises most: as a green laser looks in a blue room.
  LineScene scene;
  scene.ambient = {86, 55, 36};
  scene.noise = 1;
  const cv::Mat room = scene.draw();
  cv::Mat picture = room.clone();
  cv::line(picture, {0, 80}, {199, 90}, cv::Scalar(155, 163, 137), 3);
  const ExtractedLine line = extract(picture);
  EXPECT_GE(line.samples.size(), 195U);
  EXPECT_TRUE(extract(room).samples.empty());
}

TEST(Rejection, TheFirstProfileReliesOnNoNeighbour) {
  for (const ProfileAxis axis : {ProfileAxis::column, ProfileAxis::row}) {
    cv::Mat picture(160, 200, CV_8UC3, cv::Scalar(10, 12, 10));
    (axis == ProfileAxis::column ? picture.at<cv::Vec3b>(2, 0) : picture.at<cv::Vec3b>(0, 2)) = {10, 200, 10};
    LineExtractorOptions options;
    options.axis = axis;
    options.min_width = 3;
    const ExtractedLine line = extract(picture, options);
    EXPECT_EQ(line.count(NoPoint::too_narrow), 1U);
    EXPECT_EQ(line.count(NoPoint::isolated), 0U);
  }
}

TEST(Rejection, BelowTheNoiseLimitIsTooDim) {
  LineScene scene = one_line();
  scene.noise = 4;
  scene.stripes[0].height = 40;
  LineExtractorOptions options;
  EXPECT_GT(extract(scene.draw(), options).samples.size(), 150U);
  options.min_snr = 20;
  const ExtractedLine line = extract(scene.draw(), options);
  EXPECT_TRUE(line.samples.empty());
  EXPECT_GT(line.count(NoPoint::too_dim), 150U);
}

TEST(Rejection, BelowTheRelativeThresholdIsTooDim) {
  LineScene scene = one_line();
  scene.stripes[0].last = 150;
  scene.stripes.push_back({wave(80, 10, 150), 2, 30, 0, 151, 199});
  LineExtractorOptions options;
  EXPECT_GE(extract(scene.draw(), options).samples.size(), 195U);
  options.relative_threshold = 0.5;
  const ExtractedLine line = extract(scene.draw(), options);
  EXPECT_NEAR(static_cast<double>(line.samples.size()), 151, 3);
  EXPECT_NEAR(line.count(NoPoint::too_dim), 49, 3);
}

TEST(Rejection, WidthLimits) {
  LineScene scene = one_line();
  LineExtractorOptions options;
  options.max_width = 4;  // a sigma of 2 px is 4.7 px wide
  EXPECT_EQ(extract(scene.draw(), options).count(NoPoint::too_wide), 200U);
  options.max_width = 80;
  options.min_width = 6;
  EXPECT_EQ(extract(scene.draw(), options).count(NoPoint::too_narrow), 200U);
}

TEST(Rejection, WidthLimitsOfTheWeightedMean) {
  LineScene scene = one_line();
  LineExtractorOptions options;
  options.centre = CentreMethod::weighted_mean;
  options.max_width = 3;  // what lies below the threshold is missing
  EXPECT_EQ(extract(scene.draw(), options).count(NoPoint::too_wide), 200U);
  options.max_width = 80;
  options.min_width = 6;
  EXPECT_EQ(extract(scene.draw(), options).count(NoPoint::too_narrow), 200U);
}

TEST(Rejection, ALongPlateauIsSaturated) {
  LineScene scene = one_line();
  scene.stripes[0] = {wave(80, 10, 150), 3, 750, 0.35};
  LineExtractorOptions options;
  options.max_saturated = 5;
  EXPECT_EQ(extract(scene.draw(), options).count(NoPoint::saturated), 200U);
}

TEST(Rejection, ALineThatLeavesThePictureIsAtTheBorder) {
  LineScene scene = one_line();
  scene.stripes[0].centre = [](double x) { return 60 - 0.6 * x; };  // leaves at x = 100
  const ExtractedLine line = extract(scene.draw());
  EXPECT_GT(line.count(NoPoint::at_border), 0U);
  for (const LineSample& s : line.samples) EXPECT_NEAR(s.v, 60 - 0.6 * static_cast<double>(s.u), 0.5);
}

TEST(Rejection, AGlintIsIsolated) {
  LineScene scene = one_line();
  scene.stripes[0].last = 120;
  cv::Mat picture = scene.draw();
  cv::circle(picture, {170, 40}, 2, cv::Scalar(30, 250, 50), cv::FILLED);
  const ExtractedLine line = extract(picture);
  EXPECT_NEAR(line.count(NoPoint::isolated), 5, 2);
  for (const LineSample& s : line.samples) EXPECT_LE(s.u, 124);
}

TEST(Rejection, TwoEqualLinesAreAmbiguous) {
  LineScene scene = one_line();
  scene.noise = 0;
  scene.stripes[0].centre = wave(50, 0, 1);
  scene.stripes.push_back({wave(110, 0, 1)});
  EXPECT_EQ(extract(scene.draw()).count(NoPoint::ambiguous), 200U);
  LineExtractorOptions options;
  options.ambiguity = 1;
  EXPECT_EQ(extract(scene.draw(), options).samples.size(), 200U);
}

TEST(Candidates, TheSecondLineIsReportedAndNotBlended) {
  LineScene scene = one_line();
  scene.stripes[0].centre = wave(60, 5, 150);
  scene.stripes.push_back({wave(100, 5, 90), 3, 70, 0, 40, 160});  // an inter-reflection
  const ExtractedLine line = extract(scene.draw());
  EXPECT_EQ(line.samples.size(), 200U);
  EXPECT_NEAR(line.with_second, 121, 4);
  for (const LineSample& s : line.samples) {
    const auto u = static_cast<double>(s.u);
    EXPECT_NEAR(s.v, scene.stripes[0].centre(u), 0.15);
    if (s.u < 45 || s.u > 155) continue;
    EXPECT_NEAR(s.second, scene.stripes[1].centre(u), 1.0);
    EXPECT_NEAR(s.second_ratio, 70.0 / 120, 0.1);
  }
}

TEST(Candidates, ALineBrokenByTextureBeatsALongFaintReflection) {
  LineScene scene = one_line();
  scene.stripes.clear();
  for (int x = 0; x < 200; x += 40) scene.stripes.push_back({wave(60, 0, 1), 2, 140, 0, x, x + 24});
  scene.stripes.push_back({wave(110, 0, 1), 2, 60});
  for (const LineSample& s : extract(scene.draw()).samples) {
    const bool on_piece = static_cast<int>(s.u) % 40 <= 24;
    EXPECT_NEAR(s.v, on_piece ? 60 : 110, 1) << "column " << s.u;
  }
}

TEST(Candidates, AStepInDepthLeavesTwoPieces) {
  LineScene scene = one_line();
  scene.stripes = {{wave(50, 3, 100), 2, 120, 0, 0, 99}, {wave(110, 3, 100), 2, 50, 0, 100, 199}};
  const ExtractedLine line = extract(scene.draw());
  EXPECT_GE(line.samples.size(), 198U);
  for (const LineSample& s : line.samples) EXPECT_NEAR(s.v, s.u < 99.5F ? 50 : 110, 4);
}

TEST(Candidates, RejectedOnesAreCountedBesideTheLineToo) {
  LineScene scene = one_line();
  cv::Mat picture = scene.draw();
  cv::line(picture, {0, 140}, {199, 140}, cv::Scalar(110, 140, 180), 3);
  const ExtractedLine line = extract(picture);
  EXPECT_EQ(line.samples.size(), 200U);
  EXPECT_EQ(line.rejected_candidates[static_cast<std::size_t>(NoPoint::wrong_colour)], 200U);
}

}  // namespace
}  // namespace linescope
