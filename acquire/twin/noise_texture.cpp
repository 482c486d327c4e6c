#include "acquire/twin/noise_texture.hpp"

#include <algorithm>
#include <array>

namespace linescope::twin {
namespace {

// The values of smooth_noise at many places, sorted: its quantiles, whatever its distribution is.
std::array<double, 4096> sorted_values() {
  std::array<double, 4096> values{};
  Dice dice(0, Stream::texture);
  for (double& v : values) {
    v = smooth_noise(7, Eigen::Vector3d(dice.uniform(0, 1e4), dice.uniform(0, 1e4), dice.uniform(0, 1e4)));
  }
  std::sort(values.begin(), values.end());
  return values;
}

}  // namespace

double threshold_for_share(double share) {
  static const auto values = sorted_values();
  const double index = std::clamp(share, 0.0, 1.0) * static_cast<double>(values.size());
  if (index < 1) return 0.0;
  return values[std::min(static_cast<std::size_t>(index), values.size()) - 1];
}

}  // namespace linescope::twin
