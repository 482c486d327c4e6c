#include "acquire/twin/site_profile.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace linescope::twin {
namespace {

using Powers = Eigen::Matrix<double, 1, 5>;

constexpr int kSamples = 41;
constexpr double kFromAbove = 200;  // mm, above everything

Powers powers(double x) {
  return {1, x, x * x, x * x * x, x * x * x * x};
}

}  // namespace

SiteProfile::SiteProfile(const Phantom& phantom, double half_length) : half_length_(half_length) {
  // Where the phantom ends the row is zero on both sides and does not count.
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(kSamples, 5);
  Eigen::VectorXd heights = Eigen::VectorXd::Zero(kSamples);
  for (int i = 0; i < kSamples; ++i) {
    const double x = half_length * (2.0 * i / (kSamples - 1) - 1);
    Hit hit;
    if (!phantom.cast({x, 0, kFromAbove}, {0, 0, -1}, hit)) continue;
    rows.row(i) = powers(x / half_length);
    heights[i] = kFromAbove - hit.distance;
  }
  coefficients_ = rows.completeOrthogonalDecomposition().solve(heights);
}

double SiteProfile::clamped(double x) const {
  return std::clamp(x / half_length_, -1.0, 1.0);
}

double SiteProfile::height(double x) const {
  return powers(clamped(x)) * coefficients_;
}

Eigen::Vector3d SiteProfile::normal(double x) const {
  const double s = clamped(x);
  const Powers slope{0, 1, 2 * s, 3 * s * s, 4 * s * s * s};
  const double dz = (slope * coefficients_).value() / half_length_;
  return Eigen::Vector3d(-dz, 0, 1).normalized();
}

}  // namespace linescope::twin
