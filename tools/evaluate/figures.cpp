#include "tools/evaluate/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/evaluate/svg_chart.hpp"

namespace linescope::evaluate {
namespace {

using Eigen::Vector2d;

constexpr const char* kThesisColour = "#333c49";
constexpr const char* kPlainColour = "#c4571b";
constexpr const char* kBetterColour = "#1b6ec4";
constexpr const char* kBentColour = "#b5179e";
constexpr std::size_t kRowsPerGap = 3, kErrorRow = 0, kDeviationRow = 1;

void draw_estimates(SvgChart& chart, const Table& table, const std::vector<double>& gaps, std::size_t row,
                    bool better, double aside, const char* colour) {
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    const Row& r = table.rows[kRowsPerGap * i + row];
    const auto& e = better ? r.better : r.plain;
    if (!e) continue;
    const double x = gaps[i] + aside;
    chart.dot(x, e->mean, 4, colour);
    if (std::isfinite(e->half_width))
      chart.whisker(x, std::max(0.0, e->mean - e->half_width), e->mean + e->half_width, colour);
  }
}

void draw_thesis(SvgChart& chart, const Table& table, const std::vector<double>& gaps, std::size_t row,
                 const char* dashes) {
  std::vector<Vector2d> points;
  for (std::size_t i = 0; i < gaps.size(); ++i)
    points.emplace_back(gaps[i], table.rows[kRowsPerGap * i + row].thesis.value_or(0));
  chart.line(points, kThesisColour, 2, dashes);
}

std::vector<Vector2d> arc(const Vector2d& centre, double radius, double low, double high) {
  std::vector<Vector2d> points;
  for (int i = 0; i <= 60; ++i) {
    const double x = std::lerp(low, high, i / 60.0), along = x - centre.x();
    points.emplace_back(x, centre.y() + std::sqrt(std::max(0.0, radius * radius - along * along)));
  }
  return points;
}

/// Blue inside, white on the truth, red outside; full colour at `limit`.
std::string diverging(double error, double limit) {
  const double share = std::clamp(error / limit, -1.0, 1.0);
  const auto fade = [&](double full) {
    return static_cast<int>(std::lround(std::lerp(245.0, full, std::abs(share))));
  };
  return share > 0 ? fmt::format("rgb({},{},{})", fade(190), fade(30), fade(30))
                   : fmt::format("rgb({},{},{})", fade(25), fade(80), fade(190));
}

void draw_printed(SvgChart& chart, double x, const char* name, double mean, double deviation, double low,
                  double high) {
  chart.whisker(x, low, high, kThesisColour);
  chart.box(x, 0.18, mean - deviation, mean + deviation, kThesisColour);
  chart.line({{x - 0.18, mean}, {x + 0.18, mean}}, kThesisColour);
  chart.text(x, -1.6, name);
}

void draw_box(SvgChart& chart, double x, const char* name, const std::vector<double>& values,
              const char* colour) {
  chart.text(x, -1.6, name);
  if (values.empty()) return;
  const Box b = box_of(values);
  chart.whisker(x, b.low, b.high, colour);
  chart.box(x, 0.18, b.quarter, b.three_quarters, colour);
  chart.line({{x - 0.18, b.median}, {x + 0.18, b.median}}, colour);
}

}  // namespace

Figure error_per_gap_figure(const Table& flat, const Table& bent, const std::vector<double>& gaps_mm) {
  SvgChart chart(860, 380, {9, 21, 2, "gap, mm"}, {0, 1.4, 0.2, "mm"});
  draw_thesis(chart, flat, gaps_mm, kErrorRow, "");
  draw_thesis(chart, flat, gaps_mm, kDeviationRow, "6 4");
  draw_estimates(chart, flat, gaps_mm, kErrorRow, false, -0.2, kPlainColour);
  draw_estimates(chart, flat, gaps_mm, kDeviationRow, false, 0.0, "#e0a070");
  draw_estimates(chart, flat, gaps_mm, kDeviationRow, true, 0.15, kBetterColour);
  draw_estimates(chart, bent, gaps_mm, kDeviationRow, false, 0.3, kBentColour);
  chart.legend(kThesisColour, "thesis: error, SD (dashed)");
  chart.legend(kPlainColour, "error, thesis's algorithms");
  chart.legend("#e0a070", "SD, thesis's algorithms");
  chart.legend(kBetterColour, "SD, better algorithms");
  chart.legend(kBentColour, "SD with the bent sheet");
  return {"error-per-gap",
          "Plane in water: error and standard deviation over the gap (Table 4.1). Bars: 95 % interval "
          "of the mean over the seeds.",
          chart.svg()};
}

Figure fitted_cylinder_figure(const Points2& section, double true_diameter) {
  SvgChart chart(860, 0, {-18, 18, 6, "across the axis, mm"}, {-8, 2, 2, "height, mm"}, true);
  const std::size_t step = section.size() / 1500 + 1;
  for (std::size_t i = 0; i < section.size(); i += step)
    chart.dot(section[i].x(), section[i].y(), 1, "#9fb6cf");
  const double radius = true_diameter / 2;
  chart.line(arc({0, -radius}, radius, -16, 16), kThesisColour, 1.5, "6 4");
  chart.legend("#9fb6cf", "points");
  chart.legend(kThesisColour, fmt::format("true, {:g} mm", true_diameter));
  if (const auto circle = geometric_circle(section)) {
    chart.line(arc(circle->centre, circle->radius, -16, 16), kPlainColour, 1.5);
    chart.legend(kPlainColour, fmt::format("fitted, {:.2f} mm", 2 * circle->radius));
  }
  return {"fitted-cylinder",
          "Cylinder of 49.1 mm in water, seed 1: cross-section of the points and the fitted circle "
          "(Eq 4.16).",
          chart.svg()};
}

Figure error_map_figure(const std::vector<MapPoint>& map) {
  constexpr double kVertexPixels = 28, kStep = 0.2;  // vertices are 1.27 mm apart: no gaps between them
  double limit = kStep;
  for (const MapPoint& p : map) limit = std::max(limit, kStep * std::ceil(std::abs(p.error) / kStep));
  SvgChart chart(860, 0, {-16, 16, 4, "along the site, mm"}, {-8, 8, 4, "across, mm"}, true);
  for (const MapPoint& p : map) chart.square(p.x, p.y, kVertexPixels, diverging(p.error, limit));
  for (const double share : {1.0, 0.5, 0.0, -0.5, -1.0})
    chart.legend(diverging(share * limit, limit), fmt::format("{:+.1f} mm", share * limit));
  return {"error-map",
          "Femoral condyle, seed 1: how far the measured surface (better algorithms) lies outside (red) or "
          "inside (blue) the true one.",
          chart.svg()};
}

Figure navigation_boxes_figure(const std::vector<double>& plain, const std::vector<double>& better) {
  double top = 30;
  for (const double error : plain) top = std::max(top, 5 * std::ceil(error / 5));
  for (const double error : better) top = std::max(top, 5 * std::ceil(error / 5));
  SvgChart chart(980, 380, {0.5, 5.5, 0, ""}, {0, top, 5, "error of the normal, degrees"});
  draw_printed(chart, 1, "freehand, harvest", 14.8, 7.53, 6, 26);
  draw_printed(chart, 2, "freehand, recipient", 12.6, 3.98, 4, 17);
  draw_printed(chart, 3, "thesis", 9.5, 2.86, 5, 17);
  draw_box(chart, 4, "ours, Algorithm 1", plain, kPlainColour);
  draw_box(chart, 5, "ours, robust", better, kBetterColour);
  chart.legend(kThesisColour, "printed: mean, SD, range");
  chart.legend(kPlainColour, "all spots of all seeds:");
  chart.legend(kBetterColour, "median, quartiles, range");
  return {"navigation",
          "Navigation errors on the 50 mm cylinder. Of the printed groups only mean, SD and range are "
          "known; ours are boxes over all single errors.",
          chart.svg()};
}

}  // namespace linescope::evaluate
