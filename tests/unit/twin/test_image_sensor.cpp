// The sensor and what disturbs it: each effect has the stated size, and none when switched off.
#include <gtest/gtest.h>

#include <cmath>

#include "acquire/twin/disturbances.hpp"
#include "acquire/twin/image_sensor.hpp"
#include "acquire/twin/noise_texture.hpp"
#include "acquire/twin/speckle.hpp"
#include "picture_line.hpp"
#include "twin_fixture.hpp"

namespace linescope::twin {
namespace {

SensorOptions silent() {
  SensorOptions options;
  options.read_noise = 0;
  options.electrons_per_level = 0;
  options.bloom = 0;
  options.chroma_subsampling = false;
  return options;
}

LightImage even(float level, int width = 200, int height = 100) {
  LightImage light;
  light.clear(width, height);
  for (auto& pixel : light.bgr) pixel = {level, level, level};
  return light;
}

cv::Mat exposed(LightImage light, const SensorOptions& options, std::uint64_t index = 0) {
  cv::Mat bgr;
  ImageSensor(1, options).expose(light, index, bgr);
  return bgr;
}

struct Moments {
  double mean, variance;
};

Moments moments(const cv::Mat& bgr) {
  double sum = 0, squares = 0;
  const double count = static_cast<double>(bgr.total()) * 3;
  for (int v = 0; v < bgr.rows; ++v) {
    for (int i = 0; i < 3 * bgr.cols; ++i) {
      sum += bgr.ptr(v)[i];
      squares += bgr.ptr(v)[i] * bgr.ptr(v)[i];
    }
  }
  return {sum / count, squares / count - sum / count * sum / count};
}

TEST(ImageSensor, SilentSensorRoundsAndClips) {
  EXPECT_EQ(exposed(even(100.4F), silent()).at<cv::Vec3b>(5, 5), cv::Vec3b(100, 100, 100));
  EXPECT_EQ(exposed(even(100.6F), silent()).at<cv::Vec3b>(5, 5), cv::Vec3b(101, 101, 101));
  EXPECT_EQ(exposed(even(1000.0F), silent()).at<cv::Vec3b>(5, 5), cv::Vec3b(255, 255, 255));
}

TEST(ImageSensor, NoiseIsReadNoisePlusShotNoise) {
  SensorOptions options = silent();
  options.read_noise = 2.0;
  options.electrons_per_level = 20;
  const Moments at = moments(exposed(even(120), options));
  // Read 4, shot 120/20 = 6, rounding 1/12.
  EXPECT_NEAR(at.mean, 120, 0.1);
  EXPECT_NEAR(at.variance, 4 + 6 + 1.0 / 12, 0.25);
}

TEST(ImageSensor, NoiseChangesFromPictureToPicture) {
  SensorOptions options = silent();
  options.read_noise = 2.0;
  EXPECT_FALSE(same_pixels(exposed(even(120), options, 0), exposed(even(120), options, 1)));
  EXPECT_TRUE(same_pixels(exposed(even(120), options, 3), exposed(even(120), options, 3)));
}

TEST(ImageSensor, SaturatedPixelsSpillAlongTheirColumn) {
  LightImage light = even(10);
  light.at(50, 50) = {555, 555, 555};
  SensorOptions options = silent();
  options.bloom = 0.2;
  const cv::Mat bgr = exposed(light, options);
  EXPECT_EQ(green(bgr, 50, 50), 255);
  EXPECT_EQ(green(bgr, 50, 49), 10 + 60);  // 0.2 * (555 - 255)
  EXPECT_EQ(green(bgr, 50, 51), 10 + 60);
  EXPECT_EQ(green(bgr, 49, 50), 10);
}

TEST(ImageSensor, ChromaIsSharedByTwoNeighbours) {
  LightImage light = even(50);
  light.at(20, 10) = {50, 200, 50};  // one green pixel; its partner is 21
  SensorOptions options = silent();
  options.chroma_subsampling = true;
  const cv::Mat bgr = exposed(light, options);
  const auto excess = [&](int u) { return green(bgr, u, 10) - bgr.at<cv::Vec3b>(10, u)[2]; };
  EXPECT_NEAR(excess(20), 75, 4) << "half of its colour is left";
  EXPECT_NEAR(excess(21), 75, 4) << "the other half went to the neighbour";
  EXPECT_NEAR(excess(22), 0, 2);
  const auto luma = [&](int u) {
    const cv::Vec3b p = bgr.at<cv::Vec3b>(10, u);
    return 0.114 * p[0] + 0.587 * p[1] + 0.299 * p[2];
  };
  EXPECT_NEAR(luma(20), 50 + 0.587 * 150, 1.5) << "brightness stays where it was";
  EXPECT_NEAR(luma(21), 50, 1.5);
}

TEST(Speckle, HasMeanOneAndTheStatedContrast) {
  LineOptions line;
  line.speckle_contrast = 0.3;
  double sum = 0, squares = 0;
  constexpr int kSide = 300;
  for (int v = 0; v < kSide; ++v) {
    for (int u = 0; u < kSide; ++u) {
      const double f = speckle_factor(line, 1, 0, u, v);
      ASSERT_GE(f, 0);
      sum += f;
      squares += f * f;
    }
  }
  const double count = kSide * kSide, mean = sum / count;
  EXPECT_NEAR(mean, 1, 0.01);
  EXPECT_NEAR(std::sqrt(squares / count - mean * mean), 0.3, 0.015);
}

TEST(Speckle, NeighboursAreAlikeFarPixelsAreNot) {
  LineOptions line;
  line.speckle_contrast = 0.3;
  line.speckle_size_px = 3;
  const auto correlation = [&](int step) {
    double sum = 0;
    constexpr int kCount = 20000;
    for (int i = 0; i < kCount; ++i) {
      const int u = i % 200, v = i / 200;
      sum += (speckle_factor(line, 1, 0, u, v) - 1) * (speckle_factor(line, 1, 0, u + step, v) - 1);
    }
    return sum / kCount / (0.3 * 0.3);
  };
  EXPECT_GT(correlation(1), 0.5);
  EXPECT_LT(std::abs(correlation(8)), 0.06);
}

TEST(NoiseTexture, ThresholdCoversTheWantedShare) {
  for (const double share : {0.1, 0.35, 0.5}) {
    const double threshold = threshold_for_share(share);
    Dice dice(2, Stream::texture, 99);
    int below = 0;
    constexpr int kCount = 20000;
    for (int i = 0; i < kCount; ++i) {
      below +=
          smooth_noise(5, {dice.uniform(0, 900), dice.uniform(0, 900), dice.uniform(0, 900)}) < threshold;
    }
    EXPECT_NEAR(static_cast<double>(below) / kCount, share, 0.02);
  }
  EXPECT_EQ(threshold_for_share(0), 0);
}

TwinOptions quiet_sweep() {
  TwinOptions options = ideal_twin("condyle", Scenario::sweeps);
  options.optics.light.led_brightness = 40;
  return options;
}

// Columns of the line that are bright, over several seconds.
double lit_columns(const TwinOptions& options) {
  double lit = 0;
  const auto frames = pictures(options, 90);
  for (const Frame& frame : frames) {
    for (int u = 100; u < 260; ++u) {
      int excess = 0;
      for (int v = 0; v < frame.bgr.rows; ++v) {
        excess = std::max(excess, green(frame.bgr, u, v) - frame.bgr.at<cv::Vec3b>(v, u)[2]);
      }
      lit += excess > 20;
    }
  }
  return lit / static_cast<double>(frames.size());
}

TEST(Trouble, MissingStretchesHideTheirShareOfTheLine) {
  TwinOptions options = quiet_sweep();
  const double all = lit_columns(options);
  EXPECT_GT(all, 150);
  options.optics.trouble.missing = 0.5;
  // 90 pictures hold some fifty independent stretches: one in seven by chance.
  EXPECT_NEAR(lit_columns(options) / all, 0.5, 0.15);
}

TEST(Trouble, InterReflectionDrawsASecondFainterLine) {
  TwinOptions options = quiet_sweep();
  options.optics.light.led_brightness = 0;
  options.hand.scenario = Scenario::still;
  const auto runs = [&] {
    const cv::Mat bgr = picture(options);
    int count = 0;
    bool lit = false;
    for (int v = 0; v < bgr.rows; ++v) {
      const bool now = green(bgr, 180, v) > 6;
      count += now && !lit;
      lit = now;
    }
    return count;
  };
  EXPECT_EQ(runs(), 1);
  options.optics.trouble.inter_reflection = 0.3;
  EXPECT_EQ(runs(), 2);
}

TEST(Trouble, GlintsSaturate) {
  TwinOptions options = quiet_sweep();
  const auto saturated = [](const std::vector<Frame>& frames) {
    int count = 0;
    for (const Frame& frame : frames) {
      for (int v = 0; v < frame.bgr.rows; ++v) {
        for (int u = 0; u < frame.bgr.cols; ++u) count += green(frame.bgr, u, v) == 255;
      }
    }
    return count;
  };
  options.optics.line.brightness = 100;
  EXPECT_EQ(saturated(pictures(options, 20)), 0);
  options.optics.trouble.glints = 6;
  EXPECT_GT(saturated(pictures(options, 20)), 100);
}

TEST(Trouble, BloodDarkensItsShareOfTheSurface) {
  TwinOptions options = quiet_sweep();
  options.optics.line.brightness = 0;
  options.optics.light.texture = 0;
  options.phantom = *phantom_from_name("plane");
  options.optics.trouble.blood = 0.4;
  int blood = 0, seen = 0;
  for (const Frame& frame : pictures(options, 60)) {
    for (int v = 0; v < frame.bgr.rows; v += 3) {
      for (int u = 0; u < frame.bgr.cols; u += 3) {
        const cv::Vec3b p = frame.bgr.at<cv::Vec3b>(v, u);
        if (p[2] < 4) continue;
        ++seen;
        blood += p[2] > 2 * p[1] + 1;
      }
    }
  }
  // The sweep crosses only some ten patches of 4 mm: their share scatters.
  EXPECT_GT(static_cast<double>(blood) / seen, 0.2);
  EXPECT_LT(static_cast<double>(blood) / seen, 0.6);
}

TEST(Trouble, BloodSwallowsTheLaser) {
  TwinOptions options = quiet_sweep();
  options.hand.scenario = Scenario::still;
  options.phantom = *phantom_from_name("plane");
  options.optics.light.led_brightness = 0;
  const auto brightest = [&] {
    int most = 0;
    const cv::Mat bgr = picture(options);
    for (int v = 0; v < bgr.rows; ++v) most = std::max(most, green(bgr, 180, v));
    return most;
  };
  EXPECT_GT(brightest(), 120);
  options.optics.trouble.blood = 0.9;  // all but everywhere
  options.seed = 3;
  EXPECT_LT(brightest(), 20);
}

TEST(Trouble, ParticlesCoverTheLine) {
  LightImage light = even(200, 300, 200);
  TroubleOptions trouble;
  trouble.particles = 10;
  Disturbances(3, trouble).add(light, 5.0);
  int dimmed = 0;
  for (const auto& pixel : light.bgr) dimmed += pixel[1] < 150;
  EXPECT_GT(dimmed, 100);
  EXPECT_LT(dimmed, 300 * 200 / 4);
}

}  // namespace
}  // namespace linescope::twin
