// The daily check: figures of a scan whose errors are known, the tracker at rest, and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tools/calibrate/shape_check.hpp"
#include "tools/calibrate/still_check.hpp"

namespace linescope::calibrate {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

struct Scan {
  Shape shape = Shape::plane;
  double radius = 25;
  double noise_mm = 0.1;
  double pass_offset_mm = 0;  ///< every other pass lies this higher
  double length_mm = 24;
  int passes = 4;
};

double height(const Scan& scan, double x, double y) {
  if (scan.shape == Shape::plane) return 0;
  const double across = scan.shape == Shape::sphere ? y * y : 0;
  return std::sqrt(scan.radius * scan.radius - x * x - across) - scan.radius;
}

std::vector<ScanLine> scanned(const Scan& scan) {
  std::mt19937_64 engine(5);
  std::normal_distribution<double> normal(0, scan.noise_mm);
  std::vector<ScanLine> lines;
  constexpr int kLines = 60;
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.7, Vector3d(1, 2, -1).normalized()));
  for (int pass = 0; pass < scan.passes; ++pass) {
    for (int i = 0; i < kLines; ++i) {
      const double part = (pass % 2 == 0 ? i : kLines - 1 - i) / (kLines - 1.0);
      ScanLine line;
      for (double y = -5; y <= 5; y += 0.2) {
        const double x = (part - 0.5) * scan.length_mm;
        const double offset = pass % 2 == 0 ? 0 : scan.pass_offset_mm;
        line.emplace_back(turn * Vector3d(x, y, height(scan, x, y) + offset + normal(engine)) +
                          Vector3d(40, -10, 90));
      }
      lines.push_back(line);
    }
  }
  return lines;
}

ShapeCheckOptions options_for(const Scan& scan) {
  ShapeCheckOptions options;
  options.shape = scan.shape;
  options.diameter_mm = 2 * scan.radius;
  return options;
}

class AllShapes : public testing::TestWithParam<Shape> {};

TEST_P(AllShapes, NoiseIsPrecisionAndHeldOutError) {
  const Scan scan{.shape = GetParam()};
  const auto check = check_shape(scanned(scan), options_for(scan));
  ASSERT_TRUE(check) << check.error().message;
  EXPECT_NEAR(check->precision_mm, 0.1, 0.005);
  EXPECT_NEAR(check->target_error_mm, 0.1, 0.005);
  EXPECT_NE(check->target_error_mm, check->residual_mm);
  EXPECT_LT(std::abs(check->bias_mm), 0.15);
  EXPECT_LT(check->repeatability_mm, 0.01);
  EXPECT_EQ(check->passes, 4u);
  EXPECT_NEAR(check->extent_mm, 24, 0.5);
  EXPECT_TRUE(above_limit(*check, options_for(scan)));
}

INSTANTIATE_TEST_SUITE_P(Shapes, AllShapes, testing::Values(Shape::plane, Shape::cylinder, Shape::sphere),
                         [](const auto& shape) { return std::string(name(shape.param)); });

TEST(ShapeCheck, AWrongSizeIsBias) {
  Scan scan{.shape = Shape::cylinder, .noise_mm = 0.02};
  ShapeCheckOptions options = options_for(scan);
  options.diameter_mm = 49;  // of a body of 50
  const auto check = check_shape(scanned(scan), options);
  ASSERT_TRUE(check) << check.error().message;
  EXPECT_NEAR(check->bias_mm, 1, 0.1);
  const auto limit = above_limit(*check, options);
  ASSERT_FALSE(limit);
  EXPECT_EQ(limit.error().code, ErrorCode::above_limit);
  EXPECT_THAT(limit.error().message, HasSubstr("bias"));
}

// A ball of 2 m diameter bulges by 24^2 / (8 * 1000) = 0.072 mm over 24 mm.
TEST(ShapeCheck, ABentPlaneShowsItsSagitta) {
  Scan scan{.shape = Shape::cylinder, .radius = 1000, .noise_mm = 0.001};
  const auto lines = scanned(scan);
  const auto check = check_shape(lines, {});
  ASSERT_TRUE(check);
  EXPECT_NEAR(std::abs(check->bias_mm), 0.072, 0.003);
}

// Two passes of four lie 0.2 mm higher: means +-0.1, standard deviation of four such values 0.115.
TEST(ShapeCheck, PassesThatDisagreeShowAsRepeatability) {
  const auto check = check_shape(scanned({.noise_mm = 0.01, .pass_offset_mm = 0.2}), {});
  ASSERT_TRUE(check);
  EXPECT_NEAR(check->repeatability_mm, 0.1155, 0.005);
}

TEST(ShapeCheck, FewLinesALineHeldInPlaceAndASinglePassAreRefused) {
  auto lines = scanned({});
  lines.resize(20);
  EXPECT_EQ(check_shape(lines, {}).error().code, ErrorCode::too_few);
  const auto held = check_shape(scanned({.length_mm = 1}), {});
  EXPECT_EQ(held.error().code, ErrorCode::too_little_variation);
  EXPECT_THAT(held.error().message, HasSubstr("Sweep the line"));
  const auto once = check_shape(scanned({.passes = 1}), {});
  EXPECT_EQ(once.error().code, ErrorCode::too_little_variation);
  EXPECT_THAT(once.error().message, HasSubstr("to and fro"));
}

TEST(ShapeCheck, LimitsThatCannotBeAreRefused) {
  EXPECT_TRUE(validate(ShapeCheckOptions{}));
  EXPECT_FALSE(validate(ShapeCheckOptions{.diameter_mm = 0}));
  EXPECT_FALSE(validate(ShapeCheckOptions{.most_bias_mm = 0}));
  EXPECT_TRUE(validate(StillOptions{}));
  EXPECT_FALSE(validate(StillOptions{.least_seconds = 0}));
}

struct Rest {
  double jitter_mm = 0.05, drift_mm = 0, seconds = 5;
  float distortion = std::numeric_limits<float>::quiet_NaN();
  double moves_at = 1e9;  ///< s; afterwards it moves away
};

std::vector<PoseSample> resting(const Rest& rest) {
  std::mt19937_64 engine(3);
  std::normal_distribution<double> normal(0, rest.jitter_mm / std::sqrt(3.0));
  std::vector<PoseSample> samples;
  for (double t = 0; t < rest.seconds; t += 1 / 240.0) {
    PoseSample s;
    s.time = nanoseconds_from_seconds(t);
    s.state = ToolState::ok;
    s.distortion = rest.distortion;
    const double away = 100 * std::max(0.0, t - rest.moves_at) + (t > rest.seconds / 2 ? rest.drift_mm : 0);
    s.world_from_sensor = {Eigen::Quaterniond::Identity(),
                           Vector3d(300 + away + normal(engine), normal(engine), normal(engine))};
    samples.push_back(s);
  }
  return samples;
}

TEST(StillTracker, JitterAndDriftAreThoseOfTheSensor) {
  const auto f = still_stretch(resting({.jitter_mm = 0.1, .drift_mm = 0.4}), 1);
  EXPECT_NEAR(f.seconds, 5, 0.01);
  EXPECT_NEAR(f.drift_mm, 0.4, 0.02);
  EXPECT_NEAR(f.jitter_mm, std::hypot(0.1, 0.2), 0.01);
  const auto limit = above_limit({f}, StillOptions{});
  ASSERT_FALSE(limit);
  EXPECT_THAT(limit.error().message, HasSubstr("sensor 2: drift"));
}

TEST(StillTracker, OnlyTheStretchAtRestCounts) {
  const auto f = still_stretch(resting({.seconds = 6, .moves_at = 3}), 0);
  EXPECT_NEAR(f.seconds, 3, 0.1);
  EXPECT_LT(f.jitter_mm, 0.15);
}

TEST(StillTracker, MetalIsAboveTheLimit) {
  const auto f = still_stretch(resting({.distortion = 45}), 0);
  const auto limit = above_limit({f}, StillOptions{});
  ASSERT_FALSE(limit);
  EXPECT_THAT(limit.error().message, HasSubstr("metal indicator"));
}

TEST(StillTracker, NobodyAtRestIsRefused) {
  const std::vector<StillStation> stations = {still_stretch(resting({.seconds = 1}), 0),
                                              still_stretch({}, 1)};
  const auto still = check_still(stations, StillOptions{});
  ASSERT_FALSE(still);
  EXPECT_EQ(still.error().code, ErrorCode::too_few);
  EXPECT_THAT(still.error().message, HasSubstr("Lay at least one"));
}

}  // namespace
}  // namespace linescope::calibrate
