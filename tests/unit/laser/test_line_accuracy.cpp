// Errors against drawn truth, beside the bound that no unbiased estimator can pass: for a Gaussian of sigma
// s, height A in noise n, (n / A) sqrt(2 s / sqrt(pi)) (Winick 1986).
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <tuple>

#include "tests/unit/laser/line_scene.hpp"

namespace linescope {
namespace {

using testing::LineScene;
using testing::place;
using testing::profile;
using testing::wave;

double bound(double sigma, double height, double noise) {
  return noise / height * std::sqrt(2 * sigma / std::sqrt(std::numbers::pi));
}

struct Errors {
  double rms = 0, mean = 0;
  int n = 0;
};

Errors errors_of(LineScene scene, const LineExtractorOptions& options, int pictures) {
  LineExtractor extractor(options);
  double squares = 0, sum = 0;
  int n = 0;
  for (int i = 0; i < pictures; ++i) {
    scene.seed = 100 + static_cast<unsigned>(i);
    const double shift = 0.37 * i;
    const auto centre = [shift](double x) { return 100 + 30 * std::sin(0.02 * x) + 0.013 * x + shift; };
    scene.stripes[0].centre = centre;
    const ExtractedLine& line = extractor.extract(scene.draw());
    for (const LineSample& s : line.samples) {
      const double e = place(line, s) - centre(profile(line, s));
      squares += e * e;
      sum += e;
      ++n;
    }
  }
  return {std::sqrt(squares / n), sum / n, n};
}

class Bound : public ::testing::TestWithParam<std::tuple<ProfileAxis, double, double, double>> {};

TEST_P(Bound, IsReachedWithinATenth) {
  const auto [axis, sigma, height, noise] = GetParam();
  LineScene scene;
  scene.width = scene.height = 256;
  scene.axis = axis;
  scene.noise = noise;
  scene.stripes.push_back({wave(0, 0, 1), sigma, height});
  LineExtractorOptions options;
  options.axis = axis;
  const Errors e = errors_of(scene, options, 24);
  // All profiles but a few: the share that finds nothing must not hide the bad ones.
  EXPECT_GT(e.n, 24 * 256 * 0.995);
  EXPECT_LE(e.rms, 1.10 * bound(sigma, height, noise));
  EXPECT_LE(std::abs(e.mean), 0.1 * bound(sigma, height, noise));
}

INSTANTIATE_TEST_SUITE_P(Lines, Bound,
                         ::testing::Combine(::testing::Values(ProfileAxis::column, ProfileAxis::row),
                                            ::testing::Values(1.5, 2.0, 3.0), ::testing::Values(90.0, 170.0),
                                            ::testing::Values(2.0, 4.0)));

TEST(WeightedMean, IsTheThesissAndNearlyThreeTimesTheBound) {
  LineScene scene;
  scene.width = scene.height = 256;
  scene.noise = 4;
  scene.ambient = {30, 45, 60};
  scene.stripes.push_back({wave(0, 0, 1), 2.0, 130});
  LineExtractorOptions options;
  options.centre = CentreMethod::weighted_mean;
  options.colour_threshold = 40;
  const double ratio = errors_of(scene, options, 24).rms / bound(2, 130, 4);
  EXPECT_GT(ratio, 2.0);
  EXPECT_LT(ratio, 3.2);
}

TEST(SaturatedCore, DoesNotPullTheMiddleAside) {
  // Three times brighter than the camera can see, the core white because the other channels see a fifth of
  // it.
  for (const CentreMethod method : {CentreMethod::weighted_mean, CentreMethod::gauss_weighted}) {
    LineScene scene;
    scene.width = scene.height = 256;
    scene.noise = 2;
    scene.ambient = {5, 5, 5};
    scene.stripes.push_back({wave(0, 0, 1), 3.0, 750, 0.35});
    LineExtractorOptions options;
    options.centre = method;
    const Errors e = errors_of(scene, options, 6);
    EXPECT_GT(e.n, 6 * 256 * 0.99);
    EXPECT_LT(e.rms, 0.15);
    EXPECT_LT(std::abs(e.mean), 0.02);
  }
}

TEST(SaturatedCore, IsReportedForTheExposure) {
  LineScene scene;
  scene.stripes.push_back({wave(80, 20, 150), 3.0, 750, 0.35});
  LineExtractor extractor(LineExtractorOptions{});
  const ExtractedLine& line = extractor.extract(scene.draw());
  EXPECT_FLOAT_EQ(line.saturated_fraction, 1);
  // 750 exp(-d^2 / 18) + 40 > 245 for d < 4.83: nine or ten pixels.
  for (const LineSample& s : line.samples) EXPECT_NEAR(s.saturated, 9.5, 1.6);
}

TEST(AmbientEdge, DoesNotPullTheMiddleAside) {
  // A dark square ends one and a half sigma below the line, as under a chessboard.
  LineScene scene;
  scene.noise = 1;
  scene.stripes.push_back({wave(80, 0, 1), 3.0, 100});
  cv::Mat board = scene.draw();
  LineScene bare = scene;
  bare.ambient = {6, 8, 10};
  bare.draw().rowRange(85, scene.height).copyTo(board.rowRange(85, scene.height));
  LineExtractor extractor(LineExtractorOptions{});
  const ExtractedLine& line = extractor.extract(board);
  double worst = 0;
  for (const LineSample& s : line.samples) worst = std::max(worst, std::abs(static_cast<double>(s.v) - 80));
  EXPECT_GE(line.samples.size(), 195U);
  EXPECT_LT(worst, 0.4);
}

}  // namespace
}  // namespace linescope
