// The harvester's axis from poses taken while the tool turns about it in a bushing: R a = w for all of them
// (a: tool's frame, w: fixture's frame), and R q + p stays in place for every point q of the axis.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/result.hpp"
#include "tools/calibrate/tool_poses.hpp"

namespace linescope::calibrate {

struct SpinOptions {
  int least_poses = 60;          ///< 10 .. 1000000
  double least_spin_deg = 40;    ///< RMS turn about the axis; 5 .. 180
  double most_wobble_deg = 1.0;  ///< RMS angle of the axis about its mean; 0.01 .. 20
  double outlier_sigmas = 5;     ///< 3 .. 100
};
Result<void> validate(const SpinOptions& options);

struct SpinFit {
  Eigen::Vector3d axis{0, 0, 1};   ///< unit, tool's frame; which way is open until oriented_axis()
  Eigen::Vector3d point{0, 0, 0};  ///< mm, tool's frame: the axis's point nearest to the sensor
  double axis_deviation_rad = 0;   ///< standard deviation per direction across the axis
  double residual_rad = 0;         ///< RMS angle of the axis about its mean
  double held_out_rad = 0;         ///< the same over poses that were in no fit
  double point_residual_mm = 0;    ///< RMS sideways play of the axis
  double spin_deg = 0;             ///< what SpinOptions::least_spin_deg limits
  std::vector<bool> used;          ///< per pose
  std::vector<double> error;       ///< rad, per pose
};

/// Refuses like fit_pivot: a tool that did not turn enough, or that turned about more than one axis.
Result<SpinFit> fit_spin(const ToolPoses& poses, const SpinOptions& options = {});

Result<void> above_limit(const SpinFit& fit, const SpinOptions& options);

/// The axis from the tip to the handle, where the sensor is (the frame's origin). `tip` of length 0 is not
/// known yet: then the side of `previous` is kept.
Eigen::Vector3d oriented_axis(const Eigen::Vector3d& axis, const Eigen::Vector3d& tip,
                              const Eigen::Vector3d& previous);

/// How far a tip lies beside the axis, mm: two measurements that know nothing of each other.
double tip_beside_axis(const SpinFit& fit, const Eigen::Vector3d& tip);

}  // namespace linescope::calibrate
