// A deliberately simple way to find the line in a rendered picture: the tests must not lean on the product's
// extraction.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/core/mat.hpp>

namespace linescope::twin {

inline int green(const cv::Mat& bgr, int u, int v) {
  return bgr.at<cv::Vec3b>(v, u)[1];
}

/// Mean row of column u weighted with green; NaN when its brightest pixel stays below `least`.
inline double line_row(const cv::Mat& bgr, int u, int least = 30) {
  double sum = 0, rows = 0;
  int brightest = 0;
  for (int v = 0; v < bgr.rows; ++v) {
    const int level = green(bgr, u, v);
    brightest = std::max(brightest, level);
    sum += level;
    rows += static_cast<double>(level) * v;
  }
  return brightest >= least ? rows / sum : std::numeric_limits<double>::quiet_NaN();
}

/// Pixels whose green exceeds red by more than `excess`: laser light, since tissue and LED are never green.
inline int laser_pixels(const cv::Mat& bgr, int excess = 25) {
  int count = 0;
  for (int v = 0; v < bgr.rows; ++v) {
    for (int u = 0; u < bgr.cols; ++u) count += green(bgr, u, v) - bgr.at<cv::Vec3b>(v, u)[2] > excess;
  }
  return count;
}

inline bool same_pixels(const cv::Mat& a, const cv::Mat& b) {
  if (a.size() != b.size() || a.type() != b.type()) return false;
  for (int v = 0; v < a.rows; ++v) {
    if (!std::equal(a.ptr(v), a.ptr(v) + a.cols * a.elemSize(), b.ptr(v))) return false;
  }
  return true;
}

}  // namespace linescope::twin
