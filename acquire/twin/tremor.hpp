// The unsteadiness of a hand: physiological tremor (8-12 Hz) and slow wander (0.2-0.9 Hz), smooth in time.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace linescope::twin {

class Tremor {
 public:
  /// `index` tells one tremor from the others of the same seed. Amplitudes in whatever unit the user wants
  /// back.
  Tremor(std::uint64_t seed, std::uint64_t index, double tremor_amplitude, double wander_amplitude);

  Eigen::Vector3d at(double seconds) const;

 private:
  struct Tone {
    Eigen::Vector3d amplitude;
    double radians_per_second;
    double phase;
  };
  std::array<Tone, 6> tones_;
};

}  // namespace linescope::twin
