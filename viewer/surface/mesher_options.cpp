#include "viewer/surface/mesher_options.hpp"

#include <fmt/format.h>

#include <cmath>

namespace linescope {
namespace {

Result<void> in_range(const char* name, double value, double low, double high, const char* unit) {
  if (value >= low && value <= high) return {};
  return fail(ErrorCode::invalid, fmt::format("surface option {} is {}: it must lie between {} and {} {}",
                                              name, value, low, high, unit));
}

}  // namespace

Result<void> validate(const MesherOptions& options) {
  if (!(options.interval > 0) || !std::isfinite(options.interval))
    return fail(
        ErrorCode::invalid,
        fmt::format("surface option interval (cubic interval t) is {}: it must be a positive number of mm, "
                    "for example 1.27",
                    options.interval));
  const Result<void> checks[] = {
      in_range("max_distance", options.max_distance, 1e-3, 1e4, "mm"),
      in_range("max_deviation", options.max_deviation, 1e-6, 1e3, "mm"),
      in_range("isovalue", options.isovalue, 1e-3, 1e9, "points"),
      in_range("typical_deviation", options.typical_deviation, 1e-4, 10, "mm"),
      in_range("typical_curvature", options.typical_curvature, 1e-4, 100, "1/mm"),
      in_range("min_points", options.min_points, 3, 1e6, "points"),
      in_range("min_lines", options.min_lines, 1, 1e4, "lines"),
      in_range("fill_holes_up_to", options.fill_holes_up_to, 0, 1e4, "mm"),
      in_range("sweep_pause", seconds_from(options.sweep_pause), 1e-3, 1e6, "s"),
      in_range("max_memory", static_cast<double>(options.max_memory), 1e5, 1e13, "bytes"),
  };
  for (const Result<void>& check : checks)
    if (!check) return check;
  return {};
}

}  // namespace linescope
