// Smooth random values over space: colour of tissue, blood, soft tissue in the way of the light, speckle.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

#include "acquire/twin/dice.hpp"

namespace linescope::twin {

/// [0, 1) at a lattice point.
inline double lattice_value(std::uint64_t seed, std::int64_t i, std::int64_t j, std::int64_t k) {
  const auto u = [](std::int64_t v) { return static_cast<std::uint64_t>(v); };
  const std::uint64_t h = scrambled(seed + u(i) * 0x9e3779b97f4a7c15ULL + u(j) * 0xc2b2ae3d27d4eb4fULL +
                                    u(k) * 0x165667b19e3779f9ULL);
  return static_cast<double>(h >> 11) * 0x1p-53;
}

/// Trilinear between lattice points one unit apart, eased; mean 1/2, in [0, 1).
inline double smooth_noise(std::uint64_t seed, const Eigen::Vector3d& place) {
  const Eigen::Vector3d cell = place.array().floor();
  const Eigen::Array3d t = (place - cell).array();
  const Eigen::Array3d f = t * t * (3 - 2 * t);
  const auto i = static_cast<std::int64_t>(cell.x()), j = static_cast<std::int64_t>(cell.y()),
             k = static_cast<std::int64_t>(cell.z());
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const int x = corner & 1, y = (corner >> 1) & 1, z = (corner >> 2) & 1;
    const double weight = (x ? f.x() : 1 - f.x()) * (y ? f.y() : 1 - f.y()) * (z ? f.z() : 1 - f.z());
    sum += weight * lattice_value(seed, i + x, j + y, k + z);
  }
  return sum;
}

/// The value below which smooth_noise lies in a share [0, 1] of all places.
double threshold_for_share(double share);

}  // namespace linescope::twin
