// A chart with two axes as SVG.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

namespace linescope::evaluate {

struct Axis {
  double low = 0, high = 1;
  double tick = 0;  ///< distance of the labelled ticks; 0: none
  std::string label;
};

class SvgChart {
 public:
  /// `equal_scales`: one unit is as long on both axes; the height follows from the width then.
  SvgChart(int width, int height, Axis x, Axis y, bool equal_scales = false);

  /// In the chart's units. Colours are SVG's.
  void dot(double x, double y, double radius_px, std::string_view colour);
  void square(double x, double y, double size_px, std::string_view colour);
  void line(const std::vector<Eigen::Vector2d>& points, std::string_view colour, double width_px = 2,
            std::string_view dashes = {});
  /// A vertical line with short bars at both ends.
  void whisker(double x, double low, double high, std::string_view colour);
  void box(double x, double half_width, double low, double high, std::string_view colour);
  void text(double x, double y, std::string_view what, std::string_view anchor = "middle");
  /// One more line of the legend, right of the chart.
  void legend(std::string_view colour, std::string_view what);

  std::string svg() const;

 private:
  double px(double x) const;
  double py(double y) const;
  void frame();

  int width_, height_;
  Axis x_, y_;
  std::string body_;
  int legends_ = 0;
};

}  // namespace linescope::evaluate
