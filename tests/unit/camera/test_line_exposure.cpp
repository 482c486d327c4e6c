// The controller against a model of a camera that clips at 255 and answers three pictures late.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <vector>

#include "acquire/camera/line_exposure.hpp"

namespace linescope {
namespace {

constexpr LineExposureOptions kOptions{};

/// 201 profiles whose brightness spreads by a factor of 1.6 on both sides; `laser` is the median's grey
/// levels per ms.
LineLight seen(double laser, double exposure_ms) {
  std::vector<double> peaks;
  int saturated = 0, found = 0;
  for (int i = -100; i <= 100; ++i) {
    const double level = laser * exposure_ms * std::pow(1.6, i / 100.0);
    saturated += level >= 255 ? 1 : 0;
    found += level >= 8 ? 1 : 0;
    peaks.push_back(std::min(level, 255.0));
  }
  return {found / 201.0, found > 0 ? static_cast<double>(saturated) / found : 0, peaks[100]};
}

class Camera {
 public:
  explicit Camera(double exposure_ms) : pipeline_(3, exposure_ms) {}
  double expose(double asked) {
    pipeline_.push_back(asked);
    const double now = pipeline_.front();
    pipeline_.pop_front();
    return now;
  }

 private:
  std::deque<double> pipeline_;
};

struct Scene {
  double laser;
  double start_ms;
};
class Convergence : public ::testing::TestWithParam<Scene> {};

TEST_P(Convergence, EndsWithAnUnburntBrightLineAndStaysThere) {
  const auto [laser, start] = GetParam();
  LineExposureController controller(kOptions, start);
  Camera camera(start);
  for (int i = 0; i < 80; ++i) controller.update(seen(laser, camera.expose(controller.advice().exposure_ms)));
  const double settled = controller.advice().exposure_ms;
  const LineLight light = seen(laser, settled);
  EXPECT_LE(light.saturated, kOptions.max_saturated);
  EXPECT_GE(light.peak, kOptions.low_peak);
  EXPECT_EQ(controller.advice().hint, LaserHint::fine);
  for (int i = 0; i < 100; ++i) {
    controller.update(seen(laser, camera.expose(controller.advice().exposure_ms)));
    ASSERT_EQ(controller.advice().exposure_ms, settled) << "it hunts";
  }
}

INSTANTIATE_TEST_SUITE_P(FromEverywhere, Convergence,
                         ::testing::Values(Scene{100, 0.1}, Scene{100, 20}, Scene{15, 0.1}, Scene{15, 20},
                                           Scene{1000, 20}, Scene{1000, 0.1}, Scene{40, 4}));

TEST(LineExposure, GoodLineIsLeftAlone) {
  const ExposureAdvice advice = advise_exposure({0.9, 0.01, 170}, 5, kOptions);
  EXPECT_EQ(advice.exposure_ms, 5);
  EXPECT_EQ(advice.hint, LaserHint::fine);
  EXPECT_EQ(advice.reason, "line good");
}

TEST(LineExposure, DimLineIsBroughtToTheTargetInOneStepWhereTheStepAllows) {
  EXPECT_DOUBLE_EQ(advise_exposure({0.9, 0, 100}, 5, kOptions).exposure_ms, 5 * 180 / 100.0);
  EXPECT_DOUBLE_EQ(advise_exposure({0.9, 0, 20}, 5, kOptions).exposure_ms, 10) << "at most a factor of two";
}

TEST(LineExposure, MoreBurntOutIsALargerStep) {
  const double little = advise_exposure({0.9, 0.1, 255}, 5, kOptions).exposure_ms;
  const double much = advise_exposure({0.9, 1.0, 255}, 5, kOptions).exposure_ms;
  EXPECT_LT(little, 5);
  EXPECT_LT(much, little);
  EXPECT_DOUBLE_EQ(much, 2.5);
}

TEST(LineExposure, LimitsOfTheCameraBecomeHintsForTheLaser) {
  EXPECT_EQ(advise_exposure({0.9, 0.8, 255}, kOptions.min_exposure_ms, kOptions).hint, LaserHint::lower);
  EXPECT_EQ(advise_exposure({0.9, 0, 30}, kOptions.max_exposure_ms, kOptions).hint, LaserHint::raise);
  EXPECT_EQ(advise_exposure({0, 0, 0}, kOptions.max_exposure_ms, kOptions).hint, LaserHint::raise);
  EXPECT_EQ(advise_exposure({0.9, 0.8, 255}, 5, kOptions).hint, LaserHint::fine)
      << "the camera can still help";
}

TEST(LineExposure, HintAloneForCamerasWithoutExposure) {
  EXPECT_EQ(laser_hint({0.9, 0.8, 255}, kOptions), LaserHint::lower);
  EXPECT_EQ(laser_hint({0.9, 0, 30}, kOptions), LaserHint::raise);
  EXPECT_EQ(laser_hint({0.9, 0, 180}, kOptions), LaserHint::fine);
}

TEST(LineExposure, NumbersThatAreNoneCountAsNoLine) {
  const double nan = std::nan("");
  const ExposureAdvice advice = advise_exposure({nan, nan, nan}, 5, kOptions);
  EXPECT_EQ(advice.reason, "no line");
  EXPECT_TRUE(std::isfinite(advice.exposure_ms));
}

TEST(LineExposure, OneOddPictureDoesNotFlickerTheHint) {
  LineExposureController controller(kOptions, kOptions.min_exposure_ms);
  for (int i = 0; i < 20; ++i) controller.update({0.9, 0.01, 170});
  controller.update({0.9, 0.9, 255});
  EXPECT_EQ(controller.advice().hint, LaserHint::fine);
  for (int i = 0; i < 20; ++i) controller.update({0.9, 0.9, 255});
  EXPECT_EQ(controller.advice().hint, LaserHint::lower);
}

TEST(LineExposure, ImpossibleLaserEndsInAHint) {
  for (const auto& [laser, hint] : {std::pair{1e5, LaserHint::lower}, std::pair{0.5, LaserHint::raise}}) {
    LineExposureController controller(kOptions, 5);
    Camera camera(5);
    for (int i = 0; i < 120; ++i)
      controller.update(seen(laser, camera.expose(controller.advice().exposure_ms)));
    EXPECT_EQ(controller.advice().hint, hint);
  }
}

TEST(LineExposure, QualityIsTheShareOfGoodProfilesTimesTheirHeight) {
  EXPECT_DOUBLE_EQ(line_quality({0.8, 0.25, 180}, 180), 0.6);
  EXPECT_DOUBLE_EQ(line_quality({1, 0, 90}, 180), 0.5);
  EXPECT_DOUBLE_EQ(line_quality({1, 0, 255}, 180), 1);
  EXPECT_DOUBLE_EQ(line_quality({0, 0, 0}, 180), 0);
}

TEST(LineExposure, ImpossibleOptionsAreRefused) {
  EXPECT_TRUE(validate(kOptions));
  EXPECT_FALSE(validate(LineExposureOptions{.min_exposure_ms = 30}));
  EXPECT_FALSE(validate(LineExposureOptions{.target_peak = 250}));
  EXPECT_FALSE(validate(LineExposureOptions{.max_saturated = 1.5}));
  EXPECT_FALSE(validate(LineExposureOptions{.largest_step = 1}));
  EXPECT_FALSE(validate(LineExposureOptions{.settle_pictures = -1}));
}

}  // namespace
}  // namespace linescope
