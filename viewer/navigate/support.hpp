// Is there surface all around the foot, or would a normal here be a guess?
#pragma once

#include "viewer/navigate/normal_estimate.hpp"
#include "viewer/navigate/patch.hpp"

namespace linescope {

struct SupportOptions {
  int fewest_points = 200;             ///< used, within the patch
  int fewest_lines = 6;                ///< used, within the patch
  double ring = 2.5;                   ///< the foot must be surrounded by surface within this radius, mm
  double clear = 1.0;                  ///< nearer surface does not show that there is more of it that way, mm
  double widest_empty_angle = 2.0;     ///< largest angle about the foot without surface in that ring, rad
  double largest_hole = 1.0;           ///< from the foot to the nearest used piece of surface, mm
  Nanoseconds oldest = 600 * kSecond;  ///< age of the newest line
  double largest_uncertainty =
      0.0873;                   ///< half angle of the 95 % cone by the scan's own noise, rad (5 degrees)
  double largest_cone = 0.175;  ///< half angle of the whole 95 % cone, rad (10 degrees)
};

/// Counts, age and the verdict on the patch's used segments (weight > 0). `ring` and `clear` shrink with a
/// patch smaller than the ring. The foot is refused as one-sided nearer to a straight border than clear *
/// cos(widest_empty_angle / 2).
struct Support {
  NormalReason reason = NormalReason::none;
  NormalCounts counts;
  Nanoseconds newest = 0;
};
Support judge_support(const Patch& patch, Nanoseconds now, const SupportOptions& options);

}  // namespace linescope
