#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "tests/unit/laser/line_scene.hpp"

namespace linescope {
namespace {

using testing::LineScene;
using testing::place;
using testing::profile;
using testing::total;
using testing::wave;

struct Way {
  LaserColour colour;
  ProfileAxis axis;
  CentreMethod method;
};

/// Thesis 4.2.3 as a loop over every pixel: positions weighted with the colour excess where it reaches the
/// threshold. Pixels come and go whole at the threshold, which moves this mean by up to 0.1 px.
std::vector<double> mean_by_definition(const cv::Mat& picture, const LineExtractorOptions& options) {
  const bool column = options.axis == ProfileAxis::column;
  const int profiles = column ? picture.cols : picture.rows, length = column ? picture.rows : picture.cols;
  std::vector<double> mean;
  for (int p = 0; p < profiles; ++p) {
    double sum = 0, moment = 0;
    for (int i = 0; i < length; ++i) {
      const auto pixel = column ? picture.at<cv::Vec3b>(i, p) : picture.at<cv::Vec3b>(p, i);
      int lit = 255, dark = 0;
      for (int c = 0; c < 3; ++c) {
        const bool shines = (static_cast<int>(options.colour) >> c & 1) != 0;
        (shines ? lit : dark) = shines ? std::min<int>(lit, pixel[c]) : std::max<int>(dark, pixel[c]);
      }
      if (lit - dark < options.colour_threshold) continue;
      sum += lit - dark;
      moment += (lit - dark) * i;
    }
    mean.push_back(moment / sum);
  }
  return mean;
}

class EveryWay : public ::testing::TestWithParam<Way> {};

TEST_P(EveryWay, FindsTheLineInEveryProfile) {
  const Way way = GetParam();
  LineScene scene;
  scene.colour = way.colour;
  scene.axis = way.axis;
  scene.stripes.push_back({wave(80, 25, 150)});
  LineExtractorOptions options;
  options.colour = way.colour;
  options.axis = way.axis;
  options.centre = way.method;
  // Without colour the mean needs a threshold above the ambient light.
  if (way.colour == LaserColour::mono) options.colour_threshold = 80;
  LineExtractor extractor(options);
  const cv::Mat picture = scene.draw();
  const ExtractedLine& line = extractor.extract(picture);
  ASSERT_EQ(line.samples.size(), static_cast<std::size_t>(scene.profiles()));
  EXPECT_EQ(total(line.no_point), 0U);
  const std::vector<double> mean = way.method == CentreMethod::weighted_mean
                                       ? mean_by_definition(picture, options)
                                       : std::vector<double>{};
  for (const LineSample& s : line.samples) {
    const int p = profile(line, s);
    if (way.method == CentreMethod::weighted_mean)
      EXPECT_NEAR(place(line, s), mean[static_cast<std::size_t>(p)], 1e-4);
    else  // rounding to whole grey levels moves the middle by about 0.01 px
      EXPECT_NEAR(place(line, s), scene.stripes[0].centre(p), 0.02);
    EXPECT_FALSE(std::isfinite(s.second));
  }
}

std::string way_name(const ::testing::TestParamInfo<Way>& info) {
  return std::string(name(info.param.colour)) +
         (info.param.axis == ProfileAxis::column ? "Columns" : "Rows") +
         (info.param.method == CentreMethod::gauss_weighted ? "Gauss" : "Mean");
}

std::vector<Way> all_ways() {
  std::vector<Way> ways;
  for (int c = 1; c <= 7; ++c)
    for (const ProfileAxis a : {ProfileAxis::column, ProfileAxis::row})
      for (const CentreMethod m : {CentreMethod::weighted_mean, CentreMethod::gauss_weighted})
        ways.push_back({static_cast<LaserColour>(c), a, m});
  return ways;
}
INSTANTIATE_TEST_SUITE_P(Colours, EveryWay, ::testing::ValuesIn(all_ways()), way_name);

TEST(LineExtractor, WidthPeakAndSaturationAreTheDrawnOnes) {
  LineScene scene;
  scene.stripes.push_back({wave(80, 20, 150), 3.0, 100});
  LineExtractor extractor(LineExtractorOptions{});
  for (const LineSample& s : extractor.extract(scene.draw()).samples) {
    EXPECT_NEAR(s.width, 3.0, 0.15);
    // A matched Gaussian that is too wide by 1 % is too low by 1/2 %: the width's 5 % and half a step of the
    // tables (8 %) give up to 4.5 %.
    EXPECT_NEAR(s.peak, 100, 4);
    EXPECT_EQ(s.saturated, 0);
  }
}

TEST(LineExtractor, NoiseAndSnrAreThoseOfThePicture) {
  for (const double noise : {1.5, 4.0}) {
    LineScene scene;
    scene.noise = noise;
    scene.stripes.push_back({wave(80, 20, 150), 2.0, 120});
    LineExtractor extractor(LineExtractorOptions{});
    const ExtractedLine& line = extractor.extract(scene.draw());
    EXPECT_NEAR(line.noise, noise, 0.15 * noise);
    EXPECT_NEAR(line.mean_snr, 120 / noise, 0.2 * 120 / noise);
  }
}

TEST(LineExtractor, ARegionOfALargerPictureGivesTheSameLine) {
  LineScene scene;
  scene.noise = 3;
  scene.stripes.push_back({wave(80, 25, 150)});
  const cv::Mat alone = scene.draw();
  cv::Mat large(300, 333, CV_8UC3, cv::Scalar(0, 255, 0));
  cv::Mat region = large(cv::Rect(31, 17, alone.cols, alone.rows));
  alone.copyTo(region);
  LineExtractor a(LineExtractorOptions{}), b(LineExtractorOptions{});
  const ExtractedLine &expected = a.extract(alone), &found = b.extract(region);
  ASSERT_EQ(found.samples.size(), expected.samples.size());
  for (std::size_t i = 0; i < found.samples.size(); ++i) EXPECT_EQ(found.samples[i].v, expected.samples[i].v);
}

TEST(LineExtractor, ATransposedPictureAlongRowsGivesTheSameLine) {
  LineScene scene;
  scene.noise = 3;
  // Far from the borders: there, whole groups of pixels decide along rows what single pixels decide along
  // columns.
  scene.width = 400;
  scene.height = 400;
  scene.stripes.push_back({wave(200, 60, 300)});
  const cv::Mat picture = scene.draw();
  LineExtractorOptions along_rows;
  along_rows.axis = ProfileAxis::row;
  LineExtractor columns(LineExtractorOptions{}), rows(along_rows);
  const ExtractedLine &a = columns.extract(picture), &b = rows.extract(picture.t());
  ASSERT_EQ(a.samples.size(), b.samples.size());
  for (std::size_t i = 0; i < a.samples.size(); ++i) EXPECT_NEAR(a.samples[i].v, b.samples[i].u, 0.02);
}

TEST(LineExtractor, GreyPicturesAreMono) {
  LineScene scene;
  scene.colour = LaserColour::mono;
  scene.noise = 2;
  scene.stripes.push_back({wave(80, 25, 150)});
  cv::Mat grey;
  cv::extractChannel(scene.draw(), grey, 1);
  LineExtractor extractor(LineExtractorOptions{});
  const ExtractedLine& line = extractor.extract(grey);
  EXPECT_GE(line.samples.size(), 195U);
  for (const LineSample& s : line.samples) EXPECT_NEAR(s.v, scene.stripes[0].centre(s.u), 0.3);
}

TEST(LineExtractor, APictureDoesNotDependOnThoseBefore) {
  LineScene scene;
  scene.noise = 3;
  scene.stripes.push_back({wave(80, 25, 150)});
  const cv::Mat picture = scene.draw();
  LineScene other = scene;
  other.width = 333;
  other.stripes[0].centre = wave(60, 10, 40);
  LineExtractor fresh(LineExtractorOptions{}), used(LineExtractorOptions{});
  used.extract(other.draw());
  used.extract(cv::Mat(40, 40, CV_8UC3, cv::Scalar::all(255)));
  const ExtractedLine &a = fresh.extract(picture), &b = used.extract(picture);
  ASSERT_EQ(a.samples.size(), b.samples.size());
  EXPECT_EQ(a.no_point, b.no_point);
  for (std::size_t i = 0; i < a.samples.size(); ++i) EXPECT_EQ(a.samples[i].v, b.samples[i].v);
}

TEST(LineExtractor, UnusablePicturesAreCountedNotFollowed) {
  LineExtractor extractor(LineExtractorOptions{});
  EXPECT_EQ(extractor.extract(cv::Mat()).count(NoPoint::bad_picture), 1U);
  EXPECT_EQ(extractor.extract(cv::Mat(100, 50, CV_16UC3)).count(NoPoint::bad_picture), 50U);
  EXPECT_EQ(extractor.extract(cv::Mat(100, 50, CV_8UC4)).count(NoPoint::bad_picture), 50U);
  EXPECT_EQ(extractor.extract(cv::Mat(10, 50, CV_8UC3)).count(NoPoint::bad_picture), 50U);
  EXPECT_TRUE(extractor.extract(cv::Mat(100, 50, CV_32F)).samples.empty());
}

TEST(LineExtractor, EmptyScenesHaveNoLight) {
  LineExtractor extractor(LineExtractorOptions{});
  for (const cv::Scalar& colour : {cv::Scalar::all(0), cv::Scalar::all(255), cv::Scalar(40, 60, 80)}) {
    const ExtractedLine& line = extractor.extract(cv::Mat(120, 160, CV_8UC3, colour));
    EXPECT_TRUE(line.samples.empty());
    EXPECT_EQ(line.count(NoPoint::no_light), 160U);
  }
}

}  // namespace
}  // namespace linescope
