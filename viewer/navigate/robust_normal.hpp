// The robust estimate: foot, patch, robust quadric, grouped solution, judgement. See docs/navigation.md.
#pragma once

#include "common/result.hpp"
#include "viewer/navigate/foot_search.hpp"
#include "viewer/navigate/live_index.hpp"
#include "viewer/navigate/normal_estimate.hpp"
#include "viewer/navigate/patch_solution.hpp"
#include "viewer/navigate/robust_quadric.hpp"
#include "viewer/navigate/support.hpp"

namespace linescope {

struct RobustNormalOptions {
  double radius = 4.5;           ///< of the patch on a surface of little curvature, mm
  double smallest_radius = 1.6;  ///< never less, mm
  double curvature_reach =
      0.35;             ///< the patch reaches at most this share of the smallest radius of curvature
  double height = 3.0;  ///< segments farther from the first plane are another surface, mm
  double unseen_tilt =
      0.0;  ///< standard deviation per axis of tilts that the scan cannot show (calibration), rad
  double axis_tilt = 0.0;      ///< standard deviation per axis of the harvester's measured axis, rad
  double tip_deviation = 0.0;  ///< standard deviation per axis of the harvester's measured tip, mm
  FootSearchOptions foot;
  RobustOptions robust;
  SolutionOptions solution;
  SupportOptions support;
};

Result<void> validate(const RobustNormalOptions& options);

/// Bounded time, nothing allocated; some 200 kB of stack.
NormalEstimate robust_normal(const LiveIndex& index, const NormalQuery& query,
                             const RobustNormalOptions& options);

}  // namespace linescope
