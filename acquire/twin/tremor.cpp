#include "acquire/twin/tremor.hpp"

#include <cmath>
#include <numbers>

#include "acquire/twin/dice.hpp"

namespace linescope::twin {

Tremor::Tremor(std::uint64_t seed, std::uint64_t index, double tremor_amplitude, double wander_amplitude) {
  Dice dice(seed, Stream::hand, index);
  const std::size_t half = tones_.size() / 2;
  // The tones of one kind add in squares to the amplitude per axis.
  const double share = 1 / std::sqrt(static_cast<double>(half));
  for (std::size_t i = 0; i < tones_.size(); ++i) {
    const bool fast = i < half;
    const double hertz = fast ? dice.uniform(8.0, 12.0) : dice.uniform(0.2, 0.9);
    const double amplitude = (fast ? tremor_amplitude : wander_amplitude) * share * std::sqrt(3.0);
    tones_[i] = {dice.direction() * amplitude, 2 * std::numbers::pi * hertz,
                 dice.uniform(0, 2 * std::numbers::pi)};
  }
}

Eigen::Vector3d Tremor::at(double seconds) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Tone& tone : tones_)
    sum += tone.amplitude * std::sin(tone.radians_per_second * seconds + tone.phase);
  return sum;
}

}  // namespace linescope::twin
