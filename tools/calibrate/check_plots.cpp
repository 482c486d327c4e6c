#include "tools/calibrate/check_plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/calibrate/chart.hpp"
#include "tools/calibrate/sample_statistics.hpp"

namespace linescope::calibrate {
namespace {

/// Symmetric about zero; two points in a hundred may lie beyond.
double reach_of(std::vector<double> values) {
  for (double& v : values) v = std::abs(v);
  return values.empty() ? 1 : std::max(1e-6, high_value(std::move(values)));
}

Chart map_of(const ShapeCheck& check, const ShapeCheckOptions& options) {
  const std::string size =
      options.shape == Shape::plane ? "" : fmt::format(" of {:g} mm", options.diameter_mm);
  Chart chart{.title = fmt::format("Scanned points against the {}{}", name(options.shape), size),
              .finding = fmt::format("bias {:+.3f} mm, precision {:.3f} mm, points in no fit {:.3f} mm RMS",
                                     check.bias_mm, check.precision_mm, check.target_error_mm),
              .across = "along the scan (mm)",
              .up = "along the laser line (mm)"};
  Series points;
  for (const ShapeResidual& r : check.residuals) {
    points.points.emplace_back(r.along, r.across);
    points.values.push_back(r.distance);
  }
  const double reach = reach_of(points.values);
  chart.series = {std::move(points)};
  chart.scale = ColourScale{options.shape == Shape::plane ? "distance (mm)" : "distance (mm), + outside",
                            -reach, reach};
  chart.same_scale = true;
  chart.height = 420;
  return chart;
}

Chart lines_of(const ShapeCheck& check) {
  Chart chart{.title = "Mean distance of each laser line, pass after pass",
              .finding = fmt::format("{} lines in {} passes, repeatability {:.3f} mm", check.lines,
                                     check.passes, check.repeatability_mm),
              .across = "along the scan (mm)",
              .up = "mean distance (mm)"};
  const Ink inks[] = {Ink::blue, Ink::orange, Ink::green, Ink::red, Ink::grey};
  for (std::size_t i = 0; i < check.line_mean_mm.size(); ++i) {
    const std::size_t pass = check.line_pass[i];
    while (chart.series.size() <= pass)
      chart.series.push_back(
          {.name = chart.series.size() < 5 ? fmt::format("pass {}", chart.series.size() + 1) : std::string(),
           .ink = inks[chart.series.size() % 5],
           .joined = true});
    chart.series[pass].points.emplace_back(check.line_way_mm[i], check.line_mean_mm[i]);
  }
  chart.height = 280;
  return chart;
}

Chart rest_of(const StillStation& s, const StillOptions& options) {
  Chart chart{.title = fmt::format("Sensor {} at rest: place about its mean", s.station + 1),
              .finding = fmt::format("jitter {:.3f} mm RMS (limit {:g}), drift {:.3f} mm (limit {:g})",
                                     s.jitter_mm, options.most_jitter_mm, s.drift_mm, options.most_drift_mm),
              .across = "time (s)",
              .up = "from the mean (mm)"};
  const Ink inks[] = {Ink::blue, Ink::orange, Ink::green};
  for (int axis = 0; axis < 3; ++axis) {
    Series series{.name = std::string(1, "xyz"[axis]), .ink = inks[axis], .joined = true};
    for (const RestSample& sample : s.course) series.points.emplace_back(sample.seconds, sample.off_mm[axis]);
    chart.series.push_back(std::move(series));
  }
  chart.height = 260;
  return chart;
}

Chart places_of(const PairCheck& check, const char* up, int axis) {
  Chart chart{.across = "x in the tracker's frame (mm)", .up = up};
  Series series;
  for (const PairPlace& p : check.places) {
    series.points.emplace_back(p.at.x(), p.at[axis]);
    series.values.push_back(p.off_mm);
  }
  chart.series = {std::move(series)};
  chart.scale = ColourScale{"from the mean (mm)", 0, std::max(1e-6, check.worst_mm)};
  chart.same_scale = true;
  chart.height = 360;
  return chart;
}

}  // namespace

Plot plot_shape(const ShapeCheck& check, const ShapeCheckOptions& options) {
  return {"check-surface", page({map_of(check, options), lines_of(check)})};
}

Plot plot_still(const std::vector<StillStation>& stations, const StillOptions& options) {
  std::vector<Chart> charts;
  for (const StillStation& s : stations) charts.push_back(rest_of(s, options));
  return {"check-still", page(charts)};
}

Plot plot_pair(const PairCheck& check, const PairOptions& options) {
  Chart above = places_of(check, "y (mm)", 1), side = places_of(check, "z (mm)", 2);
  above.title = "Metal test: two sensors fixed to each other, place by place";
  above.finding = fmt::format(
      "{} places; distance differs by {:.3f} mm RMS (limit {:g}), turn by {:.3f} deg (limit {:g})",
      check.places.size(), check.rms_mm, options.most_mm, check.rms_deg, options.most_deg);
  side.title = "The same from the side";
  return {"check-metal", page({above, side})};
}

}  // namespace linescope::calibrate
