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

/// Errors between scan and harvester that the points do not know of. Standard deviations per axis.
struct Unseen {
  double surface_tilt = 0;    ///< of the whole scan, rad
  double axis_tilt = 0.0035;  ///< of the harvester's axis, rad: tremor that SteadyHarvester averages, its lag
  double tip = 0.1;           ///< of the tip against the scan, along the surface, mm

  /// With the field's distortion added: `position_mm` and `rotation_rad` are its RMS length and angle over
  /// the volume (LIBERTY's static accuracy: 0.76 mm, 0.15 degrees). Taken: components independent between the
  /// places of two sensors, levers of 150 and 180 mm, a wavelength of 250 mm over which the scan is bent.
  static Unseen of_field(double position_mm, double rotation_rad);
};

struct RobustNormalOptions {
  double radius = 4.5;           ///< of the patch on a surface of little curvature, mm
  double smallest_radius = 1.6;  ///< never less, mm
  double curvature_reach =
      0.35;                ///< the patch reaches at most this share of the smallest radius of curvature
  double agreement = 0.9;  ///< share of a patch's segments that must lie on one surface where its curvature
                           ///< asks for less than the smallest patch: otherwise it may be a crease
  double height = 3.0;     ///< segments farther from the first plane are another surface, mm
  /// What no scan can show, because it is the same at every time; see Unseen.
  Unseen unseen = Unseen::of_field(0.76, 0.0026);
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
