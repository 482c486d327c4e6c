// The session's report for people.
#include <fmt/format.h>

#include "viewer/session/session.hpp"

namespace linescope {
namespace {

constexpr const char* kHead = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>linescope session</title><style>
body { font: 15px/1.45 sans-serif; max-width: 62em; margin: 2em auto; padding: 0 1em; color: #1c2430; }
table { border-collapse: collapse; margin: .6em 0; }
th, td { text-align: left; padding: .25em 1.2em .25em 0; border-bottom: 1px solid #d5dbe3; }
td.n { text-align: right; font-variant-numeric: tabular-nums; }
.caution { background: #fdf1d7; border-left: 4px solid #c98a0b; padding: .5em 1em; font-weight: bold; }
figure { margin: 1em 0; } img { max-width: 100%; } pre { background: #f3f5f8; padding: .8em; overflow-x: auto; }
</style></head><body>
<h1>linescope session</h1>
<p class="caution">Research software. Not for clinical use.</p>
)";

std::string escaped(const std::string& raw) {
  std::string out;
  for (const char c : raw) {
    const std::string whole = c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
    out += whole;
  }
  return out;
}

std::string row(const char* what, const std::string& value) {
  return fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", what, escaped(value));
}

std::string evaluation_row(const ShapeEvaluation& e) {
  const auto number = [](bool there, double value) {
    return there ? fmt::format("<td class=\"n\">{:.3f}</td>", value)
                 : std::string("<td class=\"n\">&ndash;</td>");
  };
  return fmt::format("<tr><td>{}</td><td>{}</td><td class=\"n\">{}</td>", name(e.shape),
                     e.region.all ? "all points" : fmt::format("within {:.1f} mm", e.region.radius),
                     e.points) +
         number(true, e.mean) + number(true, e.mean_size) + number(true, e.deviation) +
         number(true, e.maximum) + number(e.has_diameter(), e.diameter) +
         number(e.has_difference(), e.nominal) + number(e.has_difference(), e.difference()) + "</tr>\n";
}

std::string evaluations(const Session& s) {
  std::string html = "<h2>Precision evaluation</h2>\n";
  if (s.evaluations.empty() && s.distances.empty()) return html + "<p>None was made.</p>\n";
  if (!s.evaluations.empty()) {
    html +=
        "<p>Distances of the points from the fitted shape, mm: this is what the shape leaves over, not the "
        "error of a "
        "place.</p>\n<table><tr><th>shape</th><th>of</th><th>points</th><th>mean</th><th>mean "
        "size</th><th>SD</th>"
        "<th>maximum</th><th>diameter</th><th>nominal</th><th>difference</th></tr>\n";
    for (const ShapeEvaluation& e : s.evaluations) html += evaluation_row(e);
    html += "</table>\n";
  }
  for (const double d : s.distances) html += fmt::format("<p>Measured distance: {:.2f} mm</p>\n", d);
  return html;
}

}  // namespace

std::string session_report(const Session& s, const std::vector<std::string>& picture_names) {
  std::string html = kHead;
  html +=
      "<table>\n" + row("Saved", s.saved) + row("By", s.program) + row("Measured by", s.daemon) +
      row("Coordinates",
          fmt::format("{} (millimetres)",
                      s.held_in == HeldIn::object ? "object's sensor (Object)" : "tracker (World)")) +
      row("Points", fmt::format("{} in {} lines (points.csv, lines.csv)", s.point_count(), s.lines.size()));
  html += row("Surface", s.mesh ? fmt::format("{} triangles, {:.0f} mm² (surface.ply)",
                                              s.mesh->triangle_count(), s.mesh->area())
                                : "none");
  html += row("Made by", fmt::format("{}, t = {} mm", s.method, s.mesher.interval)) + "</table>\n";
  html += evaluations(s);
  html += "<h2>Pictures</h2>\n";
  for (const std::string& picture : picture_names)
    html += fmt::format("<figure><img src=\"pictures/{0}\" alt=\"{0}\"></figure>\n", picture);
  html += "<h2>Diagnostics</h2>\n<pre>" + escaped(s.diagnostics) + "</pre>\n";
  html += "<h2>Configuration</h2>\n<pre>" + escaped(s.configuration) + "</pre>\n";
  return html + "<h2>Calibration</h2>\n<pre>" + escaped(s.calibration) + "</pre>\n</body></html>\n";
}

}  // namespace linescope
