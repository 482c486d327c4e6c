// A line the viewer holds, as mesher, normal estimator and fits take it.
#pragma once

#include <vector>

#include "viewer/navigate/normal_estimate.hpp"
#include "viewer/surface/surface_line.hpp"
#include "viewer/view_state.hpp"

namespace linescope {

/// The points stay the line's.
inline SurfaceLine surface_line(const HeldLine& line) {
  return {.points = line.points, .seen_from = line.seen_from, .time = line.time, .id = line.serial};
}

/// Seen along the ray to its middle point. The points stay the line's. Precondition: it has points.
inline NavigationLine navigation_line(const HeldLine& line) {
  const Eigen::Vector3d middle = line.points[line.points.size() / 2].position.cast<double>();
  return {line.serial, line.time, (middle - line.seen_from).normalized(), line.points};
}

/// Of all points, mm.
inline std::vector<Eigen::Vector3f> positions_of(const HeldLines& lines) {
  std::vector<Eigen::Vector3f> all;
  for (const auto& line : lines)
    for (const SurfacePoint& p : line->points) all.push_back(p.position);
  return all;
}

}  // namespace linescope
