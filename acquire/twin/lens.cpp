#include "acquire/twin/lens.hpp"

#include <Eigen/LU>
#include <cmath>

namespace linescope::twin {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr int kContinuationSteps = 8;
constexpr int kNewtonSteps = 12;

}  // namespace

Lens::Lens(const LensNumbers& numbers) : numbers_(numbers) {}

Vector2d Lens::bent(const Vector2d& xy) const {
  const auto& k = numbers_.distortion;
  const double s = xy.squaredNorm();
  const double scale = 1 + k[0] * s + k[1] * s * s + k[4] * s * s * s;
  // The tangential part is the gradient-like term of a lens that sits askew: s * t + 2 (t.xy) xy with t =
  // (p2, p1).
  const Vector2d askew{k[3], k[2]};
  return scale * xy + s * askew + 2 * askew.dot(xy) * xy;
}

Matrix2d Lens::bending(const Vector2d& xy) const {
  const auto& k = numbers_.distortion;
  const double s = xy.squaredNorm();
  const Vector2d askew{k[3], k[2]};
  const double scale = 1 + k[0] * s + k[1] * s * s + k[4] * s * s * s + 2 * askew.dot(xy);
  const double growth = 2 * (k[0] + 2 * k[1] * s + 3 * k[4] * s * s);
  return scale * Matrix2d::Identity() + growth * xy * xy.transpose() + 2 * askew * xy.transpose() +
         2 * xy * askew.transpose();
}

Vector2d Lens::pixel(const Vector2d& xy) const {
  const Vector2d b = bent(xy);
  return {numbers_.cx + numbers_.fx * b.x(), numbers_.cy + numbers_.fy * b.y()};
}

// Walks from the middle of the picture outwards, so that it stays on the branch that belongs to the lens.
std::optional<Vector2d> Lens::slope(double u, double v) const {
  const Vector2d target{(u - numbers_.cx) / numbers_.fx, (v - numbers_.cy) / numbers_.fy};
  Vector2d xy = Vector2d::Zero();
  for (int part = 1; part <= kContinuationSteps; ++part) {
    const Vector2d goal = target * part / kContinuationSteps;
    for (int i = 0; i < kNewtonSteps; ++i) {
      const Matrix2d slope_matrix = bending(xy);
      if (!(slope_matrix.determinant() > 0.02)) return std::nullopt;
      const Vector2d step = slope_matrix.inverse() * (goal - bent(xy));
      xy += step;
      if (step.squaredNorm() < 1e-26) break;
    }
  }
  if (!((bent(xy) - target).norm() < 1e-10)) return std::nullopt;
  return xy;
}

}  // namespace linescope::twin
