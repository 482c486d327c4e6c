#include "tests/bench/laser/scene.hpp"

#include <cmath>
#include <numbers>
#include <random>

namespace linescope::bench {

using std::numbers::pi;

double line_centre(int x, int frame) {
  return 240 + 60 * std::sin(2 * pi * x / kWidth) + 0.37 * frame + 0.013 * x;
}

double line_height(int x) {
  return 130 + 40 * std::sin(x * 0.05);
}

cv::Mat line_picture(int frame) {
  cv::Mat picture(kHeight, kWidth, CV_8UC3);
  std::mt19937_64 generator(static_cast<unsigned>(1000 + frame));
  std::normal_distribution<double> noise(0, kNoise);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const double ground = 1 + 0.2 * std::sin(x * 0.01) * std::cos(y * 0.013);
      const double d = y - line_centre(x, frame);
      const double line = line_height(x) * std::exp(-d * d / (2 * kLineSigma * kLineSigma));
      cv::Vec3b& p = picture.at<cv::Vec3b>(y, x);
      p[0] = cv::saturate_cast<uchar>(30 * ground + noise(generator));
      p[1] = cv::saturate_cast<uchar>(45 * ground + line + noise(generator));
      p[2] = cv::saturate_cast<uchar>(60 * ground + noise(generator));
    }
  }
  return picture;
}

double cramer_rao_bound() {
  double sum = 0;
  for (int x = 0; x < kWidth; ++x) {
    const double ratio = kNoise / line_height(x);
    sum += ratio * ratio * 2 * kLineSigma / std::sqrt(pi);
  }
  return std::sqrt(sum / kWidth);
}

}  // namespace linescope::bench
