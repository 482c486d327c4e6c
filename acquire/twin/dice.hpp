// Random numbers that depend on nothing but (seed, stream, index): the same whoever asks first, and in
// whatever order.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace linescope::twin {

/// Bijective scrambling of 64 bits (the finaliser of splitmix64).
constexpr std::uint64_t scrambled(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

/// What a row of random numbers is for; rows of different use never share numbers.
enum class Stream : std::uint64_t { hand, spots, field, tracker, dropout, pixels, speckle, trouble, texture };

class Dice {
 public:
  Dice(std::uint64_t seed, Stream stream, std::uint64_t index = 0)
      : state_(scrambled(scrambled(seed ^ (static_cast<std::uint64_t>(stream) << 56)) + index)) {}

  std::uint64_t bits() { return scrambled(state_++); }

  /// [0, 1)
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

  /// Standard normal (Box and Muller).
  double normal() {
    const double radius = std::sqrt(-2 * std::log(1 - uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }

  Eigen::Vector3d normal3() {
    const double x = normal(), y = normal(), z = normal();
    return {x, y, z};
  }

  Eigen::Vector3d direction() { return normal3().normalized(); }

 private:
  std::uint64_t state_;
};

}  // namespace linescope::twin
