#include "viewer/navigate/angle_interval.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace linescope {
namespace {

/// Standard deviations along the two main directions, and those directions.
struct Ellipse {
  explicit Ellipse(const Eigen::Matrix2d& covariance) {
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
    solver.computeDirect(covariance);
    half_axes = solver.eigenvalues().cwiseMax(1e-20).cwiseSqrt();
    directions = solver.eigenvectors();
  }
  Eigen::Vector2d half_axes;  ///< smaller first
  Eigen::Matrix2d directions;
};

constexpr int kDirections = 64;

Eigen::Vector2d unit(int i) {
  static const auto table = [] {
    std::array<Eigen::Vector2d, kDirections> t;
    for (int k = 0; k < kDirections; ++k) {
      const double phi = 2 * std::numbers::pi * (k + 0.5) / kDirections;
      t[static_cast<std::size_t>(k)] = {std::cos(phi), std::sin(phi)};
    }
    return t;
  }();
  return table[static_cast<std::size_t>(i)];
}

/// Largest and smallest distance from the origin of an ellipse about `centre` (own axes).
AngleInterval distances(const Eigen::Vector2d& centre, const Eigen::Vector2d& half_axes) {
  AngleInterval result{0, 0};
  double nearest = 1e300;
  for (int i = 0; i < kDirections; ++i) {
    const double d = (centre + unit(i).cwiseProduct(half_axes)).norm();
    result.high = std::max(result.high, d);
    nearest = std::min(nearest, d);
  }
  const bool origin_inside = centre.cwiseQuotient(half_axes).norm() <= 1;
  result.low = origin_inside ? 0 : nearest;
  return result;
}

/// Size of the ellipse, in standard deviations, for a true angle of `ratio` times the smaller deviation.
double reach_for(double ratio) {
  constexpr double kFar = 1.95996, kNear = 2.44775;
  return kFar + (kNear - kFar) * std::exp(-ratio * ratio / 2);
}

}  // namespace

double student_975(double degrees_of_freedom) {
  // Cornish-Fisher series about the normal quantile; exact closed forms where it does not hold.
  const double n = std::max(1.0, degrees_of_freedom), z = 1.959964, z2 = z * z;
  const double g1 = (z2 + 1) * z / 4;
  const double g2 = ((5 * z2 + 16) * z2 + 3) * z / 96;
  const double g3 = (((3 * z2 + 19) * z2 + 17) * z2 - 15) * z / 384;
  const double g4 = ((((79 * z2 + 776) * z2 + 1482) * z2 - 1920) * z2 - 945) * z / 92160;
  const double series = z + (g1 + (g2 + (g3 + g4 / n) / n) / n) / n;
  if (n >= 3) return series;
  // Between the closed forms for 1, 2 and the series at 3, on a scale where the quantile is nearly straight.
  const double at1 = std::log(12.7062), at2 = std::log(4.30265), at3 = std::log(3.18245);
  return n < 2 ? std::exp(at1 + (at2 - at1) * (1 - 1 / n) * 2)
               : std::exp(at2 + (at3 - at2) * (0.5 - 1 / n) * 6);
}

double cone_95(const TiltError& error) {
  const Ellipse ellipse(error.covariance);
  const double n = error.degrees_of_freedom;
  std::array<double, kDirections / 4> inverse;
  for (int i = 0; i < kDirections / 4; ++i)
    inverse[static_cast<std::size_t>(i)] = 1 / (n * unit(i).cwiseProduct(ellipse.half_axes).squaredNorm());
  const auto outside = [&](double angle) {
    double sum = 0;
    for (const double q : inverse) sum += std::pow(1 + angle * angle * q, -n / 2);
    return sum / static_cast<double>(inverse.size());
  };
  // P(radius > k) = (1 + k^2 / n)^(-n/2) along each direction: the answer lies between half and all of the
  // longer axis' own. False position on the logarithm, which is nearly straight.
  const double k = std::sqrt(n * (std::pow(0.05, -2 / n) - 1));
  const auto excess = [&](double angle) { return std::log(outside(angle) / 0.05); };
  double low = 0.5 * k * ellipse.half_axes[1], high = k * ellipse.half_axes[1];
  double at_low = excess(low), at_high = excess(high);
  for (int i = 0; i < 12 && high - low > 1e-4 * high && at_low > 0 && at_high < 0; ++i) {
    const double middle = low + (high - low) * at_low / (at_low - at_high);
    const double there = excess(middle);
    if (std::abs(there) < 1e-4) return middle;
    (there > 0 ? low : high) = middle;
    (there > 0 ? at_low : at_high) = there;
  }
  return high;
}

AngleInterval angle_interval_95(const Eigen::Vector2d& tilt, const TiltError& error) {
  const Ellipse ellipse(error.covariance);
  const Eigen::Vector2d centre = ellipse.directions.transpose() * tilt;
  const double student = student_975(error.degrees_of_freedom) / 1.959964;
  AngleInterval result{tilt.norm(), tilt.norm()};
  for (int round = 0; round < 3; ++round) {
    const double reach_low = student * reach_for(result.low / ellipse.half_axes[0]);
    const double reach_high = student * reach_for(result.high / ellipse.half_axes[0]);
    result = {distances(centre, reach_low * ellipse.half_axes).low,
              distances(centre, reach_high * ellipse.half_axes).high};
  }
  // Zero itself is tried by the two-dimensional ellipse alone: there is no direction to lose there.
  if (centre.cwiseQuotient(ellipse.half_axes).norm() <= student * reach_for(0)) result.low = 0;
  return result;
}

}  // namespace linescope
