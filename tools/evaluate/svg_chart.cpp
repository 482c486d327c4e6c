#include "tools/evaluate/svg_chart.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace linescope::evaluate {
namespace {

constexpr int kLeft = 60, kRight = 220, kTop = 15, kBottom = 45;
constexpr double kBar = 5;  // half a whisker's end, px

}  // namespace

SvgChart::SvgChart(int width, int height, Axis x, Axis y, bool equal_scales)
    : width_(width), height_(height), x_(std::move(x)), y_(std::move(y)) {
  if (equal_scales) {
    const double per_unit = (width_ - kLeft - kRight) / (x_.high - x_.low);
    height_ = static_cast<int>(std::lround(per_unit * (y_.high - y_.low))) + kTop + kBottom;
  }
  frame();
}

double SvgChart::px(double x) const {
  return kLeft + (x - x_.low) / (x_.high - x_.low) * (width_ - kLeft - kRight);
}

double SvgChart::py(double y) const {
  return height_ - kBottom - (y - y_.low) / (y_.high - y_.low) * (height_ - kTop - kBottom);
}

void SvgChart::frame() {
  const int right = width_ - kRight, bottom = height_ - kBottom;
  body_ +=
      fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#8a94a3\"/>\n",
                  kLeft, kTop, right - kLeft, bottom - kTop);
  for (double t = std::ceil(x_.low / x_.tick) * x_.tick; x_.tick > 0 && t <= x_.high + 1e-9; t += x_.tick) {
    body_ += fmt::format("<line x1=\"{0:.1f}\" y1=\"{1}\" x2=\"{0:.1f}\" y2=\"{2}\" stroke=\"#8a94a3\"/>",
                         px(t), bottom, bottom + 5);
    body_ += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{:g}</text>\n", px(t),
                         bottom + 18, std::abs(t) < 1e-9 ? 0.0 : t);
  }
  for (double t = std::ceil(y_.low / y_.tick) * y_.tick; y_.tick > 0 && t <= y_.high + 1e-9; t += y_.tick) {
    body_ += fmt::format("<line x1=\"{0}\" y1=\"{2:.1f}\" x2=\"{1}\" y2=\"{2:.1f}\" stroke=\"#e1e5ea\"/>",
                         kLeft, right, py(t));
    body_ += fmt::format("<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{:g}</text>\n", kLeft - 6,
                         py(t) + 4, std::abs(t) < 1e-9 ? 0.0 : t);
  }
  body_ += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", (kLeft + right) / 2,
                       height_ - 8, x_.label);
  body_ += fmt::format(
      "<text x=\"16\" y=\"{0}\" text-anchor=\"middle\" transform=\"rotate(-90 16 {0})\">{1}</text>\n",
      (kTop + bottom) / 2, y_.label);
}

void SvgChart::dot(double x, double y, double radius_px, std::string_view colour) {
  body_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"{}\"/>\n", px(x), py(y),
                       radius_px, colour);
}

void SvgChart::square(double x, double y, double size_px, std::string_view colour) {
  body_ += fmt::format("<rect x=\"{0:.1f}\" y=\"{1:.1f}\" width=\"{2}\" height=\"{2}\" fill=\"{3}\"/>\n",
                       px(x) - size_px / 2, py(y) - size_px / 2, size_px, colour);
}

void SvgChart::line(const std::vector<Eigen::Vector2d>& points, std::string_view colour, double width_px,
                    std::string_view dashes) {
  body_ += "<polyline points=\"";
  for (const Eigen::Vector2d& p : points) body_ += fmt::format("{:.1f},{:.1f} ", px(p.x()), py(p.y()));
  body_ += fmt::format("\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"", colour, width_px);
  if (!dashes.empty()) body_ += fmt::format(" stroke-dasharray=\"{}\"", dashes);
  body_ += "/>\n";
}

void SvgChart::whisker(double x, double low, double high, std::string_view colour) {
  body_ += fmt::format(
      "<path d=\"M {0:.1f} {1:.1f} V {2:.1f} M {3:.1f} {1:.1f} H {4:.1f} M {3:.1f} {2:.1f} H {4:.1f}\" "
      "stroke=\"{5}\" fill=\"none\"/>\n",
      px(x), py(low), py(high), px(x) - kBar, px(x) + kBar, colour);
}

void SvgChart::box(double x, double half_width, double low, double high, std::string_view colour) {
  body_ += fmt::format(
      "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\" "
      "fill-opacity=\"0.35\" stroke=\"{}\"/>\n",
      px(x - half_width), py(high), px(x + half_width) - px(x - half_width), py(low) - py(high), colour,
      colour);
}

void SvgChart::text(double x, double y, std::string_view what, std::string_view anchor) {
  body_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", px(x), py(y), anchor,
                       what);
}

void SvgChart::legend(std::string_view colour, std::string_view what) {
  const int x = width_ - kRight + 16, y = kTop + 14 + 20 * legends_++;
  body_ += fmt::format(
      "<rect x=\"{}\" y=\"{}\" width=\"10\" height=\"10\" fill=\"{}\"/><text x=\"{}\" y=\"{}\">{}</text>\n",
      x, y - 9, colour, x + 16, y, what);
}

std::string SvgChart::svg() const {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n{2}</svg>\n",
      width_, height_, body_);
}

}  // namespace linescope::evaluate
