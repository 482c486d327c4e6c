// The vector version of the matched Gaussian against the plain one, bit by bit, and what becomes of windows
// that leave the picture or hold no line.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "acquire/laser/gauss_centre.hpp"
#include "tests/unit/laser/line_scene.hpp"

namespace linescope {
namespace {

PictureView view_of(const cv::Mat& m) {
  return {m.data, static_cast<std::ptrdiff_t>(m.step[0]), m.cols, m.rows, m.channels()};
}

testing::LineScene tilted_line(ProfileAxis axis) {
  testing::LineScene scene;
  scene.width = scene.height = 150;
  scene.axis = axis;
  scene.noise = 6;
  // Enters and leaves through the picture's ends, so that windows of either end are cut off.
  scene.stripes.push_back({[](double x) { return 1.02 * x - 2; }, 2.0, 90});
  return scene;
}

std::vector<GaussFit> fits(const cv::Mat& picture, ProfileAxis axis, const GaussClimber& climber) {
  GaussCentre gauss(climber);
  gauss.begin(view_of(picture), axis, 1, 6.0F);
  for (int p = 0; p < 150; ++p) {
    // Starts up to two pixels beside the line, kernels of all widths, now and then other light.
    const auto start = std::clamp(static_cast<float>(1.02 * p - 2 + 2 * std::sin(p)), 0.0F, 149.0F);
    const float sigma = 0.6F + 0.08F * static_cast<float>(p % 60);
    gauss.add(p, start, sigma, p % 11 == 0 ? LightMix{1, -0.5F} : LightMix{});
  }
  return gauss.fits();
}

std::uint32_t bits(float x) {
  return std::bit_cast<std::uint32_t>(x);
}

TEST(GaussCentre, VectorsFindWhatThePlainVersionFinds) {
  for (const ProfileAxis axis : {ProfileAxis::column, ProfileAxis::row}) {
    const cv::Mat picture = tilted_line(axis).draw();
    const auto plain = fits(picture, axis, plain_gauss_climber());
    const auto fast = fits(picture, axis, fastest_gauss_climber());
    ASSERT_EQ(plain.size(), 150U);
    ASSERT_EQ(fast.size(), plain.size());
    int settled = 0;
    for (std::size_t i = 0; i < plain.size(); ++i) {
      EXPECT_EQ(fast[i].settled, plain[i].settled) << i;
      EXPECT_EQ(bits(fast[i].centre), bits(plain[i].centre)) << i;
      EXPECT_EQ(bits(fast[i].amplitude), bits(plain[i].amplitude)) << i;
      settled += plain[i].settled ? 1 : 0;
    }
    EXPECT_GT(settled, 75);
    EXPECT_LT(settled, 150);  // both outcomes occur
  }
}

TEST(GaussCentre, HeightIsTheLines) {
  testing::LineScene scene;
  scene.stripes.push_back({[](double x) { return 80 + 0.1 * x; }, 2.0, 120});
  const cv::Mat picture = scene.draw();
  GaussCentre gauss;
  gauss.begin(view_of(picture), ProfileAxis::column, 1, 0.3F);
  for (int p = 0; p < 200; ++p) gauss.add(p, 80.6F + 0.1F * static_cast<float>(p), 2.0F, {});
  for (std::size_t i = 0; i < 200; ++i) {
    const GaussFit& fit = gauss.fits()[i];
    EXPECT_TRUE(fit.settled);
    EXPECT_NEAR(static_cast<double>(fit.centre), 80 + 0.1 * static_cast<double>(i), 0.02);
    // The kernel nearest to sigma 2 is up to 4 % off, and so is the height.
    EXPECT_NEAR(static_cast<double>(fit.amplitude), 120, 5);
  }
}

TEST(GaussCentre, WithoutLightTheStartStays) {
  const cv::Mat picture(100, 32, CV_8UC3, cv::Scalar::all(50));
  GaussCentre gauss;
  gauss.begin(view_of(picture), ProfileAxis::column, 1, 1.0F);
  for (int p = 0; p < 32; ++p) gauss.add(p, 50.25F, 2.0F, {});
  for (const GaussFit& fit : gauss.fits()) {
    EXPECT_FALSE(fit.settled);
    EXPECT_EQ(fit.centre, 50.25F);
  }
}

}  // namespace
}  // namespace linescope
