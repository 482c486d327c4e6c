// Charts as pictures: axes with ticks and units, a legend, a colour scale where points carry values. Drawn
// with OpenCV alone, so that a calibration needs no window system.
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

namespace linescope::calibrate {

/// What belongs together, in one colour.
enum class Ink { blue, orange, green, red, grey };

struct Series {
  std::string name{};  ///< for the legend; empty: not named
  Ink ink = Ink::blue;
  std::vector<Eigen::Vector2d> points{};
  bool joined = false;           ///< a line through the points instead of dots
  std::vector<double> values{};  ///< as many as points: these are coloured by Chart::scale instead of `ink`
};

/// Colours for values: from `least` (blue) over the middle (pale) to `most` (red).
struct ColourScale {
  std::string label{};  ///< with unit
  double least = 0, most = 1;
};

struct Chart {
  std::string title{};         ///< one line: what is seen
  std::string finding{};       ///< one line below it: the figure that the chart shows
  std::string across{}, up{};  ///< labels of the axes, with units
  std::vector<Series> series{};
  std::optional<ColourScale> scale{};
  bool same_scale = false;  ///< a millimetre is as long across as up
  bool from_zero = false;   ///< the vertical axis shows zero
  int height = 320;         ///< px
};

inline constexpr int kChartWidth = 820;  ///< px

/// 8-bit BGR, kChartWidth wide. Points that are not finite are not drawn; a chart without any says so.
cv::Mat drawn(const Chart& chart);

/// With a line below that says what software this is and what it is not for, as long as the drawing is wide.
cv::Mat with_foot(const cv::Mat& drawing);

/// The charts one below the other, with a line that says what software this is and what it is not for.
cv::Mat page(const std::vector<Chart>& charts);

}  // namespace linescope::calibrate
