// Turns true poses into what a LIBERTY would report of them: field distortion, white noise, hemisphere,
// quantisation.
#pragma once

#include <vector>

#include "acquire/twin/tracker_options.hpp"
#include "common/rigid_transform.hpp"

namespace linescope::twin {

/// A smooth vector field with zero mean: what metal near by does. It depends on the place alone.
class SmoothField {
 public:
  /// `rms` is the root mean square of the vector's length over space.
  SmoothField(std::uint64_t seed, std::uint64_t index, double rms, double smallest_wavelength_mm);

  Eigen::Vector3d at(const Eigen::Vector3d& place) const;

 private:
  struct Wave {
    Eigen::Vector3d amplitude;
    Eigen::Vector3d wave_vector;  ///< rad/mm
    double phase;
  };
  std::vector<Wave> waves_;
};

class TrackerNoiseModel {
 public:
  TrackerNoiseModel(std::uint64_t seed, const TrackerNoise& options);

  /// What the tracker reports of a sensor that is truly at `truth`, in its `cycle`-th cycle.
  Rigid<World, Sensor> reported(const Rigid<World, Sensor>& truth, int station, std::uint64_t cycle) const;

  /// Seconds after the beginning at which the cycle is truly taken: the device's own clock.
  double true_seconds(std::uint64_t cycle) const;

  /// How much later than it could a cycle arrives at the host: the constant latency, and what the bus and the
  /// host add.
  Nanoseconds lateness(std::uint64_t cycle) const;

  /// True while this station has a drop-out.
  bool dropped(int station, double seconds) const;

 private:
  std::uint64_t seed_;
  TrackerNoise options_;
  SmoothField position_field_;
  SmoothField rotation_field_;
};

}  // namespace linescope::twin
