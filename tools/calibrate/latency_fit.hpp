// The camera's latency on the tracker's clock, from a motion that both of them saw.
//
// 1. Cross-correlation: how fast the camera turns from one picture to the next (pose of the board) against
// how
//    fast the endoscope's sensor turns over the same interval, shifted. Neither hand-eye nor the board's
//    place matters for that.
// 2. Refinement: latency, hand-eye and the board's place in the world together, so that the corners of all
//    pictures fall where they were seen (least squares in the picture). The hand-eye that comes in is only
//    the start: an error in it cannot pass into the latency.
#pragma once

#include <string>
#include <vector>

#include "common/calibration.hpp"
#include "common/pose_sample.hpp"
#include "common/result.hpp"
#include "tools/calibrate/board.hpp"
#include "tools/calibrate/turn_correlation.hpp"

namespace linescope::calibrate {

struct LatencyOptions {
  int least_pictures = 90;          ///< with the board, close enough in time to a neighbour; 20 .. 100000
  int most_pictures = 0;            ///< collecting ends with so many with the board; 0: no limit; 0 .. 100000
  double range_ms = 200;            ///< searched from -range to +range; 10 .. 1000
  double least_turn_deg_per_s = 3;  ///< RMS speed of turning; 0.1 .. 1000
  double least_correlation = 0.9;   ///< 0.5 .. 0.999
  double most_deviation_ms = 1;     ///< standard deviation of the result; 0.01 .. 100
  double most_rms_px = 5;           ///< of the corners after refinement; 0.1 .. 100
};
Result<void> validate(const LatencyOptions& options);

struct TimedBoardView {
  std::string name;
  Nanoseconds time = 0;  ///< the picture's time stamp
  BoardView view;
};

struct LatencyFit {
  Nanoseconds latency = 0;  ///< time stamp minus true instant
  double deviation_ms = 0;  ///< standard deviation
  double coarse_ms = 0;     ///< of the correlation alone
  double correlation = 0;   ///< Pearson, at its peak
  double turn_deg_per_s = 0;
  double residual_px = 0;                            ///< RMS over the corners of the fit
  double held_out_px = 0;                            ///< over the pictures that were in no fit
  std::size_t held_out = 0;                          ///< pictures behind it
  Rigid<Endoscope, CameraCv> endoscope_from_camera;  ///< as the motion shows it: for comparison only
  std::vector<std::string> names;                    ///< pictures looked at
  std::vector<double> error_px;                      ///< per picture of `names`, with the final values
  std::vector<TurnOver> turns;                       ///< of the camera between pictures, what is correlated
  std::vector<bool> used;  ///< in the fit; the others are those without poses on both sides
};

/// `poses`: of the endoscope's station, in time order. Refuses (verdict.hpp): too few pictures; too little
/// variation (hardly turned, or a motion that repeats itself so that several latencies fit); error above
/// limit (weak correlation, a peak at the end of the range).
Result<LatencyFit> fit_latency(const std::vector<TimedBoardView>& views, const std::vector<PoseSample>& poses,
                               const BoardOptions& board, const Calibration& before,
                               const LatencyOptions& options = {});

Result<void> above_limit(const LatencyFit& fit, const LatencyOptions& options);

}  // namespace linescope::calibrate
