// The thesis's Algorithm 1: the normal from an equilateral triangle inscribed in a circle about the tip
// (Eqs 5.1, 5.2, 5.4).
//
// The text leaves the choice among thousands of qualifying points open. Here it is deterministic, and
// independent of the order of the points but for exact ties, where the earlier point wins:
//   S1: the point whose distance from O is closest to r.
//   S2: smallest | |OS2| - r | + | |S1S2| - sqrt(3) r |.
//   S3: smallest | |OS3| - r | + | |S2S3| - sqrt(3) r | + | |S3S1| - sqrt(3) r |.
// Every vertex must obey Eq 5.1 (distance from O in (1, w/2)) and every side lies in (sqrt(3), sqrt(3) w/2),
// as printed.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "common/result.hpp"

namespace linescope {

struct Algorithm1Options {
  double line_width = 10.0;  ///< w, mm
  double radius = 2.0;       ///< r, mm, in (1, w/2)
};

/// The first fault, in one sentence: width or radius not finite, radius outside of Eq 5.1.
Result<void> validate(const Algorithm1Options& options);

struct InscribedTriangle {
  bool found = false;                         ///< false: `normal` is the fallback k of Eq 5.4
  std::array<Eigen::Vector3d, 3> vertices{};  ///< S1, S2, S3
  double worst_cost = 0;                      ///< largest of the three vertices' costs, mm
  Eigen::Vector3d normal{0, 0, 1};            ///< unit, out of the surface: against the viewing direction
};

/// `tip` is O. `view` (unit, from the endoscope towards the surface) orients the normal, and k = -view is the
/// fallback: the depth direction of the point set. `points`, `tip` and `view` share one frame. O(points),
/// nothing allocated.
InscribedTriangle inscribed_triangle(std::span<const Eigen::Vector3f> points, const Eigen::Vector3d& tip,
                                     const Eigen::Vector3d& view, const Algorithm1Options& options);

}  // namespace linescope
