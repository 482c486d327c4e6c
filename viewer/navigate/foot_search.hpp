// Where the harvester's axis meets the scanned surface: a first answer, good to some tenths of a millimetre.
#pragma once

#include <Eigen/Core>

#include "viewer/navigate/live_index.hpp"
#include "viewer/navigate/normal_estimate.hpp"

namespace linescope {

struct FootSearchOptions {
  double reach_ahead = 20.0;  ///< the surface may lie this far ahead of the tip, mm
  double reach_behind = 4.0;  ///< or this far behind it (the tip pressed in), mm
};

struct FoundFoot {
  NormalReason reason = NormalReason::no_surface;  ///< none when found
  Eigen::Vector3d foot = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< of the plane fitted there
  bool across_gap = false;  ///< only a wide look found it: nothing was scanned within two millimetres or so
};

/// Walks along the axis from the tip outwards, ahead and behind in turn, and takes the first crossing. `axis`
/// is unit, from the tip to the handle. Bounded time; nothing allocated.
FoundFoot find_foot(const LiveIndex& index, const Eigen::Vector3d& tip, const Eigen::Vector3d& axis,
                    const FootSearchOptions& options);

}  // namespace linescope
