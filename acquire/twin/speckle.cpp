#include "acquire/twin/speckle.hpp"

namespace linescope::twin {
namespace {

// Sum of four uniform numbers minus its mean, in units of its standard deviation: normal enough for a grain.
double grain(std::uint64_t seed, std::int64_t i, std::int64_t j) {
  std::uint64_t h = scrambled(seed + static_cast<std::uint64_t>(i) * 0x9e3779b97f4a7c15ULL +
                              static_cast<std::uint64_t>(j) * 0xc2b2ae3d27d4eb4fULL);
  double sum = -2;
  for (int k = 0; k < 4; ++k, h >>= 16) sum += static_cast<double>(h & 0xffff) / 65535.0;
  return sum * std::sqrt(3.0);
}

}  // namespace

double speckle_factor(const LineOptions& line, std::uint64_t seed, std::uint64_t picture, int u, int v) {
  if (!(line.speckle_contrast > 0)) return 1;
  const std::uint64_t row = scrambled(seed ^ scrambled(picture + 0x5bec));
  const double x = u / line.speckle_size_px, y = v / line.speckle_size_px;
  const double i = std::floor(x), j = std::floor(y);
  const double fx = x - i, fy = y - j;
  const auto at = [&](int di, int dj) {
    return grain(row, static_cast<std::int64_t>(i) + di, static_cast<std::int64_t>(j) + dj);
  };
  const double w00 = (1 - fx) * (1 - fy), w10 = fx * (1 - fy), w01 = (1 - fx) * fy, w11 = fx * fy;
  const double sum = w00 * at(0, 0) + w10 * at(1, 0) + w01 * at(0, 1) + w11 * at(1, 1);
  // Interpolation between grains would make the pixels between them calmer: scaled back to unit variance.
  const double normal = sum / std::sqrt(w00 * w00 + w10 * w10 + w01 * w01 + w11 * w11);
  const double variance = std::log1p(line.speckle_contrast * line.speckle_contrast);
  return std::exp(std::sqrt(variance) * normal - 0.5 * variance);
}

}  // namespace linescope::twin
