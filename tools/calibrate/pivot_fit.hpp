// The harvester's tip from poses taken while the tip rests in a divot and the tool swings about it: for every
// pose R t + p = c, linear in the tip t (tool's frame) and the divot c.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/result.hpp"
#include "tools/calibrate/tool_poses.hpp"

namespace linescope::calibrate {

struct PivotOptions {
  int least_poses = 60;         ///< 10 .. 1000000
  double least_swing_deg = 10;  ///< RMS about the axis about which it swung least, in its two best; 1 .. 90
  double most_rms_mm = 1.0;     ///< of the tip about the divot; above: error above limit; 0.01 .. 100
  double outlier_sigmas = 5;    ///< 3 .. 100
};
Result<void> validate(const PivotOptions& options);

struct PivotFit {
  Eigen::Vector3d tip{0, 0, 0};    ///< mm, tool's frame
  Eigen::Vector3d divot{0, 0, 0};  ///< mm, fixture's frame
  Eigen::Matrix3d tip_covariance = Eigen::Matrix3d::Zero();
  double residual_mm = 0;     ///< RMS distance of the tip from the divot, over the poses of the fit
  double held_out_mm = 0;     ///< the same over poses that were in no fit
  double swing_deg = 0;       ///< what PivotOptions::least_swing_deg limits
  double turned_deg = 0;      ///< largest turn between the mean attitude and any other
  std::vector<bool> used;     ///< per pose
  std::vector<double> error;  ///< mm, per pose
};

/// Refuses (verdict.hpp): too few poses; too little variation, with another sentence for a tool that was not
/// moved than for one that was swung about a single axis. A fit whose error is above the limit is given back
/// all the same, with its figures: above_limit() says so.
Result<PivotFit> fit_pivot(const ToolPoses& poses, const PivotOptions& options = {});

Result<void> above_limit(const PivotFit& fit, const PivotOptions& options);

}  // namespace linescope::calibrate
