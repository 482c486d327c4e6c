#include "viewer/navigate/normal_estimate.hpp"

namespace linescope {

std::string_view name(NormalReason reason) {
  switch (reason) {
    case NormalReason::none:
      return "good";
    case NormalReason::bad_query:
      return "harvester pose is not a number";
    case NormalReason::no_surface:
      return "no surface here";
    case NormalReason::axis_misses_surface:
      return "axis misses the surface";
    case NormalReason::too_few_points:
      return "not enough points here";
    case NormalReason::too_few_lines:
      return "not enough lines here";
    case NormalReason::one_sided:
      return "edge of the scan";
    case NormalReason::gap:
      return "gap in the scan";
    case NormalReason::too_old:
      return "surface too old";
    case NormalReason::too_uncertain:
      return "too uncertain";
    case NormalReason::too_curved:
      return "surface too strongly curved";
    case NormalReason::no_triangle:
      return "no triangle (Algorithm 1)";
  }
  return "unknown reason";
}

}  // namespace linescope
