// Where the rendered line lies, against closed forms that the twin does not contain (Eq 4.3 solved for the
// row), and how it looks: width, brightness, shade.
#include <gtest/gtest.h>

#include <cmath>

#include "acquire/twin/triangle_phantom.hpp"
#include "common/units.hpp"
#include "picture_line.hpp"
#include "twin_fixture.hpp"
#include "twin_shapes.hpp"

namespace linescope::twin {
namespace {

// Eq 4.3 solved for v, y up: v_o - v = b f / z - f tan(alpha).
double row_by_equation(double z) {
  constexpr double f = 609.9623 / 2, v_o = (239.4773 + 0.5) / 2 - 0.5, b = 6.0;
  return v_o - (b * f / z - f * std::tan(radians_from_degrees(14.0)));
}

// Grey levels are whole numbers: with a peak above kBright the mean row of a profile is off by less than
// kRounding px.
constexpr int kBright = 140;
constexpr double kRounding = 0.025;

// As bright as 8 bits allow at this gap.
double bright_at(double gap) {
  return 305 * gap / 15;
}

class PlaneAtGap : public testing::TestWithParam<double> {};

TEST_P(PlaneAtGap, LineLiesWhereEquation43PutsIt) {
  TwinOptions options = ideal_twin("plane");
  options.hand.gap_mm = GetParam();
  options.optics.line.brightness = bright_at(GetParam());
  const cv::Mat bgr = picture(options);
  int columns = 0;
  double sum = 0;
  for (int u = 0; u < bgr.cols; ++u) {
    const double error = line_row(bgr, u, kBright) - row_by_equation(GetParam());
    if (std::isnan(error)) continue;
    ++columns;
    sum += error;
    EXPECT_NEAR(error, 0, kRounding) << "column " << u;
  }
  ASSERT_GT(columns, 60);
  EXPECT_NEAR(sum / columns, 0, kRounding / 2);
}

INSTANTIATE_TEST_SUITE_P(Gaps, PlaneAtGap, testing::Values(10.0, 12.0, 14.0, 16.0, 18.0, 20.0));

// The endoscope stands above the cylinder's top line, the laser meets it beside: z by the circle's equation.
TEST(RenderedLine, OnACylinderItLiesWhereTheCircleMeetsTheSheet) {
  TwinOptions options = ideal_twin("cylinder-50");
  options.optics.line.brightness = bright_at(15);
  const cv::Mat bgr = picture(options);
  // The hand keeps its distance by a smooth profile, not by the circle: ask where the camera really is.
  const double gap = experiment(options)->truth().phantom_from_camera(4 * kMillisecond).translation().z();
  EXPECT_NEAR(gap, 15, 0.01);
  const double radius = 25, tangent = std::tan(radians_from_degrees(14.0));
  // Height of the line beside the axis: y = 6 - z tan(alpha); surface: z = gap + R - sqrt(R^2 - y^2).
  double z = gap;
  for (int i = 0; i < 100; ++i) z = gap + radius - std::sqrt(radius * radius - std::pow(6 - z * tangent, 2));
  for (const int u : {140, 180, 220}) EXPECT_NEAR(line_row(bgr, u, kBright), row_by_equation(z), kRounding);
}

TEST(RenderedLine, LiesTheSameOnAMeshOfTheSameBody) {
  TwinOptions options = ideal_twin("condyle");
  options.phantom.condyle_semi_axes_mm = {25, 25, 25};
  const cv::Mat analytic = picture(options);
  options.phantom.kind = PhantomKind::mesh;
  options.phantom.mesh = sphere_of_triangles(25, 6);
  const cv::Mat meshed = picture(options);
  int columns = 0;
  for (int u = 0; u < analytic.cols; ++u) {
    const double row = line_row(analytic, u, 60);
    if (std::isnan(row)) continue;
    ++columns;
    EXPECT_NEAR(line_row(meshed, u), row, 0.15);
  }
  EXPECT_GT(columns, 100);
}

TEST(RenderedLine, DimsWithDistanceAsAFanDoes) {
  const auto peak = [](double gap) {
    TwinOptions options = ideal_twin("plane");
    options.hand.gap_mm = gap;
    options.optics.line.defocus_per_mm = 0;
    const cv::Mat bgr = picture(options);
    int best = 0;
    for (int v = 0; v < bgr.rows; ++v) best = std::max(best, green(bgr, 180, v));
    return best;
  };
  EXPECT_NEAR(static_cast<double>(peak(20)) / peak(12), 12.0 / 20.0, 0.03);
}

double profile_sigma(const cv::Mat& bgr, int u) {
  const double mean = line_row(bgr, u);
  double sum = 0, squares = 0;
  for (int v = 0; v < bgr.rows; ++v) {
    sum += green(bgr, u, v);
    squares += green(bgr, u, v) * (v - mean) * (v - mean);
  }
  return std::sqrt(squares / sum);
}

TEST(RenderedLine, HasTheWidthOfItsProfileAndGrowsOffFocus) {
  TwinOptions options = ideal_twin("plane");
  options.hand.gap_mm = 15;
  options.optics.line.focus_distance_mm = 15 / std::cos(options.instrument.alpha_rad);
  // Perpendicular width, seen on the wall under alpha, through the focal length.
  const double expected = 0.09 / std::cos(options.instrument.alpha_rad) * options.instrument.lens.fy / 15;
  EXPECT_NEAR(profile_sigma(picture(options), 180), expected, 0.05 * expected);
  options.optics.line.focus_distance_mm += 12;
  options.optics.line.brightness *= 1.6;  // the same light over a wider profile: keep clear of 8-bit rounding
  EXPECT_NEAR(profile_sigma(picture(options), 180), expected * std::hypot(0.09, 0.12) / 0.09,
              0.05 * expected);
}

// A ball on a plate shades the plate behind it from the fibre.
TEST(RenderedLine, BodiesShadeWhatLiesBehindThem) {
  TwinOptions options = ideal_twin("mini-knee");
  options.optics.line.fan_half_angle_rad = 0.6;
  const cv::Mat bgr = picture(options);
  // In a column through a bump the line must appear once: on the bump, not also on the plate below it.
  for (int u = 150; u < 210; ++u) {
    int runs = 0;
    bool lit = false;
    for (int v = 0; v < bgr.rows; ++v) {
      const bool now = green(bgr, u, v) > 8;
      runs += now && !lit;
      lit = now;
    }
    EXPECT_LE(runs, 1) << "column " << u;
  }
}

TEST(RenderedLine, MotionDuringTheExposureWidensIt) {
  TwinOptions options = ideal_twin("condyle", Scenario::sweeps);
  options.hand.gap_variation_mm = 0;
  options.hand.tremor_mm = 1.0;  // a shaky hand
  options.instrument.exposure_ms = 30;
  const Frame still = pictures(options, 6).back();
  options.optics.sensor.motion_samples = 9;
  const Frame moving = pictures(options, 6).back();
  EXPECT_GT(profile_sigma(moving.bgr, 180), 1.1 * profile_sigma(still.bgr, 180));
}

}  // namespace
}  // namespace linescope::twin
