// What the steps harvester, time and hand-eye show besides their figures: how well the motion covered what is
// asked of it, and how the data lie about the fit, with the calibration in use before and with the new one.
#pragma once

#include "tools/calibrate/hand_eye_fit.hpp"
#include "tools/calibrate/harvester_step.hpp"
#include "tools/calibrate/latency_fit.hpp"

namespace linescope::calibrate {

/// Where the handle pointed, coloured by the tip's distance from the divot, and that distance over time.
Plot plot_pivot(const ToolPoses& poses, const PivotFit& fit, const Eigen::Vector3d& tip_before);

/// The axis's wobble over the turn about it and over time.
Plot plot_spin(const ToolPoses& poses, const SpinFit& fit);

/// Scatter of tip and axis over time.
Plot plot_block(const ToolPoses& poses, const BlockOptions& block, const BlockFit& fit);

/// The second in which the endoscope turned most: what camera and tracker saw, by the pictures' time stamps
/// and by the true instants, and the correlation over the shift.
Plot plot_latency(const LatencyFit& fit, const std::vector<PoseSample>& poses);

/// Per picture with the hand-eye in use before and with the new one, and over the sensor's place.
Plot plot_hand_eye(const HandEyeFit& fit, const BoardOptions& board,
                   const Rigid<Endoscope, CameraCv>& before);

}  // namespace linescope::calibrate
