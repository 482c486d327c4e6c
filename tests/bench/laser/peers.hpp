// What others do with the same pictures, by the shortest way in OpenCV.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace linescope::bench {

/// cvtColor to HSV, inRange, then the mean of the green channel inside the mask, column by column. NaN
/// without a pixel.
class HsvColumns {
 public:
  void run(const cv::Mat& bgr, std::vector<float>& centre);

 private:
  cv::Mat hsv_, mask_;
};

/// Steger's ridge detector: five separable Gaussian derivatives (sigma 2 px) of green minus the larger of
/// blue and red, then the strongest ridge point of each column.
class Steger {
 public:
  Steger();
  void run(const cv::Mat& bgr, std::vector<float>& centre);

 private:
  cv::Mat smooth_, first_, second_;  ///< kernels
  std::vector<cv::Mat> channels_;
  cv::Mat excess_, light_, x_, y_, xx_, xy_, yy_;
  std::vector<float> best_;
};

}  // namespace linescope::bench
