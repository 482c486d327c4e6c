// First, robust look at a patch: which segments belong to the surface, and its quadric.
#pragma once

#include <Eigen/Core>

#include "viewer/navigate/patch.hpp"

namespace linescope {

struct RobustOptions {
  double cut = 3.2;  ///< a segment farther from the surface than this many robust deviations is not used
  double smallest_scale = 0.03;  ///< the robust deviation is taken as at least this, mm
  bool allow_simd = true;        ///< false: the portable loops, for comparison
  double usual_curvature =
      0.05;  ///< holds the fit back while it is still small: stronger curvature needs evidence, 1/mm
};

/// z = b0 + b1 x + b2 y + b3 x^2 + b4 xy + b5 y^2 in the patch's frame, mm.
struct Quadric {
  Eigen::Matrix<double, 6, 1> b = Eigen::Matrix<double, 6, 1>::Zero();
  double scale = 0;  ///< robust standard deviation of the segments about it, mm
  int used = 0;      ///< segments

  /// Larger of the two principal curvatures' magnitudes, 1/mm, where the slope is small.
  double curvature() const;
};

/// Re-weighted least squares that grows from the foot outwards. Sets
/// patch.weight: 0 for what does not belong to the surface, otherwise 1. `used` is 0 when the segments do not
/// determine a quadric.
Quadric fit_robust_quadric(Patch& patch, const RobustOptions& options);

}  // namespace linescope
