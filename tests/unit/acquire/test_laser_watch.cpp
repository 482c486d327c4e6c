// Exposure for the line: the watch, a scripted camera whose pictures answer to it, and the real extraction.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "acquire/laser/line_extractor.hpp"
#include "acquire/laser_watch.hpp"

namespace linescope {
namespace {

using ::testing::HasSubstr;

/// A camera in front of a green line. What arrives in a pixel is laser * exposure, cut off at white.
class LitCamera final : public CameraSource {
 public:
  explicit LitCamera(double laser) : laser_(laser) {}
  Result<void> start() override { return {}; }
  bool live() const override { return true; }
  std::string description() const override { return "lit"; }
  CameraStatus status() const override { return {}; }
  Result<void> set_exposure(double milliseconds) override {
    if (!has_control_) return fail(ErrorCode::unsupported, "no such control");
    ++asked_;
    exposure_ms_ = std::clamp(milliseconds, shortest_, longest_);
    return {};
  }
  Result<Pull> next(Frame& frame) override {
    frame.bgr.create(120, 160, CV_8UC3);
    frame.bgr.setTo(cv::Scalar(2, 2, 2));
    for (int v = 0; v < frame.bgr.rows; ++v)
      for (int u = 0; u < frame.bgr.cols; ++u) paint(frame.bgr.at<cv::Vec3b>(v, u), (v - 60) / 3.0);
    return Pull::item;
  }

  double laser_;
  double exposure_ms_ = 5, shortest_ = 0, longest_ = 1e9;
  bool has_control_ = true;
  int asked_ = 0;

 private:
  void paint(cv::Vec3b& pixel, double distance) const {
    const double light = laser_ * exposure_ms_ * std::exp(-0.5 * distance * distance);
    pixel[1] = cv::saturate_cast<std::uint8_t>(light + 2);
    pixel[0] = pixel[2] = cv::saturate_cast<std::uint8_t>(0.15 * light + 2);
  }
};

class LaserWatchTest : public ::testing::Test {
 protected:
  void run(LaserWatch& watch, LitCamera& camera, int pictures) {
    Frame frame;
    for (int i = 0; i < pictures; ++i) {
      ASSERT_TRUE(camera.next(frame));
      watch.look(extractor_.extract(frame.bgr));
      watch.camera_has(camera.exposure_ms_);
    }
  }
  std::string words(const LaserWatch& watch) const {
    std::string text;
    watch.describe(text);
    return text;
  }

  LineExtractor extractor_{LineExtractorOptions{}};
  LineExposureOptions options_;
};

TEST_F(LaserWatchTest, ExposureFollowsTheLineFromBothSides) {
  for (const double laser : {400.0, 8.0}) {  // grey levels per millisecond: burnt out, and dim, at 5 ms
    LitCamera camera(laser);
    LaserWatch watch(options_, 0, camera);
    run(watch, camera, 80);
    EXPECT_EQ(watch.hint(), LaserHint::fine) << laser;
    EXPECT_LE(watch.light().saturated, options_.max_saturated) << laser;
    EXPECT_GE(watch.light().peak, options_.low_peak) << laser;
    EXPECT_LE(watch.light().peak, options_.high_peak) << laser;
    const int asked = camera.asked_;
    run(watch, camera, 80);
    EXPECT_EQ(camera.asked_, asked) << "a good line is left alone";
  }
}

TEST_F(LaserWatchTest, WhatTheCameraCannotReachBecomesAHint) {
  LitCamera bright(50'000), dark(0.5);
  LaserWatch too_bright(options_, 0, bright), too_dark(options_, 0, dark);
  run(too_bright, bright, 120);
  run(too_dark, dark, 120);
  EXPECT_EQ(too_bright.hint(), LaserHint::lower);
  EXPECT_THAT(words(too_bright), HasSubstr("lower the laser"));
  EXPECT_EQ(too_dark.hint(), LaserHint::raise);
  EXPECT_THAT(words(too_dark), HasSubstr("raise the laser"));
}

TEST_F(LaserWatchTest, TheEndOfTheCamerasOwnRangeIsLearnt) {
  LitCamera camera(8);
  camera.longest_ = 6;  // would need about 20 ms
  LaserWatch watch(options_, 0, camera);
  run(watch, camera, 120);
  EXPECT_EQ(watch.hint(), LaserHint::raise);
  const int asked = camera.asked_;
  run(watch, camera, 60);
  EXPECT_EQ(camera.asked_, asked) << "it does not ask again and again for what the camera cannot do";
}

TEST_F(LaserWatchTest, ACameraWithoutTheControlStillGivesTheHint) {
  LitCamera camera(400);
  camera.has_control_ = false;
  LaserWatch watch(options_, 0, camera);
  run(watch, camera, 60);
  EXPECT_EQ(watch.hint(), LaserHint::lower);
  EXPECT_EQ(camera.asked_, 0);
}

TEST_F(LaserWatchTest, AFixedExposureStaysUntilItIsReleased) {
  LitCamera camera(400);
  LaserWatch watch(options_, 5, camera);
  run(watch, camera, 60);
  EXPECT_EQ(camera.asked_, 0);
  EXPECT_EQ(watch.hint(), LaserHint::lower) << "the operator is told all the same";
  ASSERT_TRUE(watch.expose(2));
  run(watch, camera, 60);
  EXPECT_DOUBLE_EQ(camera.exposure_ms_, 2);
  ASSERT_TRUE(watch.expose(0));
  run(watch, camera, 80);
  EXPECT_LE(watch.light().saturated, options_.max_saturated);
  EXPECT_EQ(watch.hint(), LaserHint::fine);
}

TEST_F(LaserWatchTest, BurntAwayProfilesCountAsFoundAndBurntOut) {
  ExtractedLine line;
  line.width = 100;
  line.height = 50;
  line.samples.resize(30);
  for (std::size_t i = 0; i < 30; ++i) line.samples[i].peak = i < 10 ? 100 : 200;
  line.saturated_fraction = 0.5F;
  line.no_point[static_cast<std::size_t>(NoPoint::saturated)] = 10;
  std::vector<float> scratch;
  const LineLight light = line_light(line, scratch);
  EXPECT_DOUBLE_EQ(light.found, 0.4);
  EXPECT_DOUBLE_EQ(light.saturated, (15.0 + 10.0) / 40.0);
  EXPECT_DOUBLE_EQ(light.peak, 200);
  EXPECT_DOUBLE_EQ(line_light(ExtractedLine{}, scratch).found, 0);
}

}  // namespace
}  // namespace linescope
