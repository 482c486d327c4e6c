// The drawings of the report, as SVG: they need neither a display nor a graphics library, and stand in the
// HTML file itself.
#pragma once

#include <vector>

#include "tools/evaluate/report.hpp"
#include "viewer/measure/shape_fits.hpp"

namespace linescope::evaluate {

/// Error and SD over the gap: thesis, ours flat, ours bent. The tables are plane_table's.
Figure error_per_gap_figure(const Table& flat, const Table& bent, const std::vector<double>& gaps_mm);

/// Points of a cross-section with the circle fitted to them and the true one (its top in the origin).
Figure fitted_cylinder_figure(const Points2& section, double true_diameter);

/// A place on the surface, seen from above, mm, and how far the measured surface lies outside the true one.
struct MapPoint {
  double x = 0, y = 0, error = 0;
};
Figure error_map_figure(const std::vector<MapPoint>& map);

/// Boxes of all single errors, degrees, beside what is printed of the thesis and of freehand.
Figure navigation_boxes_figure(const std::vector<double>& plain, const std::vector<double>& better);

}  // namespace linescope::evaluate
