// A line the viewer holds, as the normal estimator takes it.
#pragma once

#include "viewer/navigate/normal_estimate.hpp"
#include "viewer/view_state.hpp"

namespace linescope {

/// Seen along the ray to its middle point. The points stay the line's. Precondition: it has points.
inline NavigationLine navigation_line(const HeldLine& line) {
  const Eigen::Vector3d middle = line.points[line.points.size() / 2].position.cast<double>();
  return {line.serial, line.time, (middle - line.seen_from).normalized(), line.points};
}

}  // namespace linescope
