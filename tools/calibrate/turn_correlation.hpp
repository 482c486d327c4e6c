// How well two histories of turning agree when one is shifted in time.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "common/pose_sample.hpp"

namespace linescope::calibrate {

/// Turn between two instants.
struct TurnOver {
  Nanoseconds from = 0, to = 0;
  double rad = 0;
  double rate() const { return rad / seconds_from(to - from); }
};

/// Attitude and place at any instant between samples that are good on both sides, at most 50 ms apart.
class PoseTrack {
 public:
  explicit PoseTrack(const std::vector<PoseSample>& samples);  ///< in time order
  std::optional<Rigid<World, Sensor>> at(Nanoseconds time) const;

  /// The same by a local quadratic through all samples within 25 ms; with fewer than six of them as at().
  /// Interpolated noise is least half way between two samples: a fit that may choose the instant would be
  /// drawn there. Here the noise is the same everywhere, and less.
  std::optional<Rigid<World, Sensor>> smooth_at(Nanoseconds time) const;

 private:
  std::vector<PoseSample> good_;
};

/// Pearson's correlation of the turn rates with those of `track` at the instants less `shift`; nothing when
/// fewer than nine tenths of them are covered by it, or nothing turned.
std::optional<double> correlation_at(const std::vector<TurnOver>& turns, const PoseTrack& track,
                                     Nanoseconds shift);

struct CorrelationPeak {
  double shift_ms = 0;
  double height = -1;   ///< correlation
  double rival = -1;    ///< the highest other local maximum
  bool at_end = false;  ///< the highest value lies at the end of the range
};

/// Over -range..range in steps of 2 ms, the peak's place by a parabola. Nothing when no shift is covered.
std::optional<CorrelationPeak> highest_correlation(const std::vector<TurnOver>& turns, const PoseTrack& track,
                                                   double range_ms);

}  // namespace linescope::calibrate
