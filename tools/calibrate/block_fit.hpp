// Tip and axis of the harvester against a block: the tool stands in a hole whose bottom and direction are
// known, so every pose gives tip and axis at once.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/result.hpp"
#include "tools/calibrate/tool_poses.hpp"

namespace linescope::calibrate {

struct BlockOptions {
  Eigen::Vector3d tip{0, 0, 0};   ///< where the tip stands, mm, in the fixture's frame
  Eigen::Vector3d axis{0, 0, 1};  ///< from the tip to the handle, in the fixture's frame; any length
  int least_poses = 60;           ///< 10 .. 1000000
  double most_rms_mm = 1.0;       ///< of the tip over the poses; 0.01 .. 100
  double most_wobble_deg = 1.0;   ///< of the axis over the poses; 0.01 .. 20
};
Result<void> validate(const BlockOptions& options);

struct BlockFit {
  Eigen::Vector3d tip{0, 0, 0};              ///< mm, tool's frame
  Eigen::Vector3d axis{0, 0, 1};             ///< unit, tool's frame
  Eigen::Vector3d tip_deviation{0, 0, 0};    ///< standard deviations, mm
  double axis_deviation_rad = 0;             ///< per direction across the axis
  double residual_mm = 0, residual_rad = 0;  ///< RMS about the means
  double held_out_mm = 0, held_out_rad = 0;  ///< each fifth about the mean of the others
};

/// Refuses too few poses.
Result<BlockFit> fit_block(const ToolPoses& poses, const BlockOptions& options);

Result<void> above_limit(const BlockFit& fit, const BlockOptions& options);

}  // namespace linescope::calibrate
