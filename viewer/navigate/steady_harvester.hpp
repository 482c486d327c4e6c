// The harvester's tip and axis without the tracker's noise: still where the hand is still, prompt where it
// moves.
//
// A single sample of a tracker is a third of a millimetre and a tenth of a degree off; at the end of a lever
// of 180 mm that moves the tip by half a millimetre, and the normal of a condyle with it by more than a
// degree. Samples are averaged in the object's frame, where a knee that moves with its sensor does not move
// the harvester. The average is an exponential one whose cut-off frequency grows with the speed (Casiez,
// Roussel and Vogel, "1 Euro filter", CHI 2012).
#pragma once

#include <Eigen/Core>
#include <optional>

#include "common/result.hpp"
#include "common/time.hpp"

namespace linescope {

struct SteadyHarvesterOptions {
  double slowest_hz = 0.8;                         ///< cut-off frequency at rest
  double tip_hz_per_speed = 0.5;                   ///< added per mm/s of the tip
  double axis_hz_per_speed = 40.0;                 ///< added per rad/s of the axis
  double speed_hz = 1.0;                           ///< cut-off frequency of the speeds themselves
  Nanoseconds longest_pause = 100 * kMillisecond;  ///< after a longer one the next sample is taken as it is
};

/// The first fault, in one sentence.
Result<void> validate(const SteadyHarvesterOptions& options);

/// One thread.
class SteadyHarvester {
 public:
  struct Hold {
    Eigen::Vector3d tip{0, 0, 0};
    Eigen::Vector3d axis{0, 0, 1};  ///< unit
  };

  /// Precondition: validate(options) is good.
  explicit SteadyHarvester(const SteadyHarvesterOptions& options = {}) : options_(options) {}

  /// The hold after a sample taken at `time`; `axis` of any length but zero. The same time again gives the
  /// same answer. A sample that is not finite, or older than the last one, begins anew.
  const Hold& follow(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, Nanoseconds time);

  /// Forgets: the harvester was lost, or the frame has changed.
  void reset() { last_.reset(); }

 private:
  SteadyHarvesterOptions options_;
  std::optional<Nanoseconds> last_;  ///< time of the last sample
  Hold sample_, steady_;
  Eigen::Vector3d tip_speed_{0, 0, 0}, axis_speed_{0, 0, 0};
};

}  // namespace linescope
