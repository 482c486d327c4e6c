// Draws laser lines with known middle for the tests.
#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <opencv2/core.hpp>
#include <random>
#include <vector>

#include "acquire/laser/line_extractor.hpp"

namespace linescope::testing {

struct Stripe {
  std::function<double(double)> centre;  ///< px along the profile, of the profile's index
  double sigma = 2;                      ///< px
  double height = 120;                   ///< grey levels in the laser's channels
  double leak = 0;                       ///< part of it that the other channels see
  int first = 0, last = 1 << 20;         ///< profiles on which it lies
};

struct LineScene {
  int width = 200, height = 160;
  LaserColour colour = LaserColour::green;
  ProfileAxis axis = ProfileAxis::column;
  cv::Vec3d ambient{30, 40, 50};  ///< blue, green, red
  double noise = 0;               ///< grey levels, standard deviation in every channel
  unsigned seed = 1;
  std::vector<Stripe> stripes;

  int profiles() const { return axis == ProfileAxis::column ? width : height; }

  cv::Mat draw() const {
    cv::Mat picture(height, width, CV_8UC3);
    std::mt19937 generator(seed);
    std::normal_distribution<double> grain(0, 1);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const int profile = axis == ProfileAxis::column ? x : y, place = axis == ProfileAxis::column ? y : x;
        cv::Vec3d light = ambient;
        for (const Stripe& s : stripes) add(s, profile, place, light);
        for (int c = 0; c < 3; ++c)
          picture.at<cv::Vec3b>(y, x)[c] =
              cv::saturate_cast<uchar>(light[c] + (noise > 0 ? noise * grain(generator) : 0.0));
      }
    }
    return picture;
  }

 private:
  void add(const Stripe& s, int profile, int place, cv::Vec3d& light) const {
    if (profile < s.first || profile > s.last) return;
    const double d = place - s.centre(profile), value = s.height * std::exp(-d * d / (2 * s.sigma * s.sigma));
    for (int c = 0; c < 3; ++c) light[c] += (static_cast<int>(colour) >> c & 1) != 0 ? value : s.leak * value;
  }
};

inline std::function<double(double)> wave(double middle, double swing, double period) {
  return [=](double x) { return middle + swing * std::sin(2 * std::numbers::pi * x / period); };
}

/// Position along the profile, whatever the axis.
inline double place(const ExtractedLine& line, const LineSample& s) {
  return static_cast<double>(line.axis == ProfileAxis::column ? s.v : s.u);
}
inline int profile(const ExtractedLine& line, const LineSample& s) {
  return static_cast<int>(line.axis == ProfileAxis::column ? s.u : s.v);
}

inline std::uint32_t total(const NoPointCounts& counts) {
  std::uint32_t sum = 0;
  for (const std::uint32_t n : counts) sum += n;
  return sum;
}

}  // namespace linescope::testing
