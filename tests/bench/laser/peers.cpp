#include "tests/bench/laser/peers.hpp"

#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

namespace linescope::bench {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

}  // namespace

void HsvColumns::run(const cv::Mat& bgr, std::vector<float>& centre) {
  cv::cvtColor(bgr, hsv_, cv::COLOR_BGR2HSV);
  cv::inRange(hsv_, cv::Scalar(40, 60, 60), cv::Scalar(80, 255, 255), mask_);
  for (int x = 0; x < bgr.cols; ++x) {
    double sum = 0, moment = 0;
    for (int y = 0; y < bgr.rows; ++y) {
      if (mask_.at<uchar>(y, x) == 0) continue;
      const double light = bgr.at<cv::Vec3b>(y, x)[1];
      sum += light;
      moment += light * y;
    }
    centre[static_cast<std::size_t>(x)] = sum > 0 ? static_cast<float>(moment / sum) : kNone;
  }
}

Steger::Steger() {
  constexpr int kRadius = 6;
  constexpr double kSigma = 2, kVariance = kSigma * kSigma;
  for (cv::Mat* kernel : {&smooth_, &first_, &second_}) kernel->create(2 * kRadius + 1, 1, CV_32F);
  for (int i = -kRadius; i <= kRadius; ++i) {
    const double g = std::exp(-i * i / (2 * kVariance)) / (std::sqrt(2 * CV_PI) * kSigma);
    smooth_.at<float>(i + kRadius) = static_cast<float>(g);
    first_.at<float>(i + kRadius) = static_cast<float>(i / kVariance * g);
    second_.at<float>(i + kRadius) = static_cast<float>((i * i / kVariance - 1) / kVariance * g);
  }
}

void Steger::run(const cv::Mat& bgr, std::vector<float>& centre) {
  cv::split(bgr, channels_);
  cv::max(channels_[0], channels_[2], excess_);
  cv::subtract(channels_[1], excess_, excess_);
  excess_.convertTo(light_, CV_32F);
  cv::sepFilter2D(light_, x_, CV_32F, first_, smooth_);
  cv::sepFilter2D(light_, y_, CV_32F, smooth_, first_);
  cv::sepFilter2D(light_, xx_, CV_32F, second_, smooth_);
  cv::sepFilter2D(light_, yy_, CV_32F, smooth_, second_);
  cv::sepFilter2D(light_, xy_, CV_32F, first_, first_);
  best_.assign(static_cast<std::size_t>(bgr.cols), 0);
  std::fill(centre.begin(), centre.end(), kNone);
  for (int v = 0; v < bgr.rows; ++v) {
    const uchar* excess = excess_.ptr(v);
    for (int u = 0; u < bgr.cols; ++u) {
      if (excess[u] < 40) continue;
      const float a = xx_.at<float>(v, u), b = xy_.at<float>(v, u), c = yy_.at<float>(v, u);
      const float half = (a + c) / 2, root = std::sqrt((a - c) * (a - c) / 4 + b * b),
                  curvature = half - root;
      const auto column = static_cast<std::size_t>(u);
      if (curvature > -best_[column]) continue;
      float nx = b, ny = curvature - a;
      const float length = std::hypot(nx, ny);
      nx = length < 1e-12F ? 0 : nx / length;
      ny = length < 1e-12F ? 1 : ny / length;
      const float gx = x_.at<float>(v, u), gy = y_.at<float>(v, u);
      const float t = -(gx * nx + gy * ny) / (a * nx * nx + 2 * b * nx * ny + c * ny * ny);
      if (std::abs(t * nx) > 0.6F || std::abs(t * ny) > 0.6F) continue;
      best_[column] = -curvature;
      centre[column] = static_cast<float>(v) + t * ny;
    }
  }
}

}  // namespace linescope::bench
