#include "viewer/navigate/robust_quadric.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace linescope {
namespace {

using Lane = Eigen::Array<float, 8, 1>;
using Sums = std::array<Lane, 27>;  // upper triangle of the 6 x 6 normal matrix, then the right side

Lane lane(const Patch::Row& row, std::size_t i) {
  return Eigen::Map<const Lane>(row.data() + i);
}

std::array<Lane, 6> features(const Patch& patch, std::size_t i, float inverse_radius) {
  const Lane x = lane(patch.x, i) * inverse_radius, y = lane(patch.y, i) * inverse_radius;
  const Lane sx = lane(patch.sx, i) * inverse_radius, sy = lane(patch.sy, i) * inverse_radius;
  // A segment's mean height is the mean of the surface over the segment, hence the squared spreads.
  return {Lane::Ones(), x, y, x * x + sx * sx, x * y + sx * sy, y * y + sy * sy};
}

/// Eight segments at a time, in single precision: this only decides what belongs to the surface.
class Reweighting {
 public:
  explicit Reweighting(Patch& patch)
      : patch_(patch),
        inverse_radius_(static_cast<float>(1 / patch.radius)),
        padded_(static_cast<std::size_t>((patch.size + 7) / 8 * 8)) {
    // Padding up to a multiple of eight with segments of no weight.
    for (auto i = static_cast<std::size_t>(patch.size); i < padded_; ++i)
      patch.x[i] = patch.y[i] = patch.z[i] = patch.sx[i] = patch.sy[i] = patch.weight[i] = 0;
  }

  /// `ridge`: how strongly curvature is held back, in units of weight times mm^2 (a segment weighs 1).
  bool solve(double ridge) {
    const Sums sums = accumulate();
    Eigen::Matrix<double, 6, 6> normal;
    Eigen::Matrix<double, 6, 1> right;
    std::size_t k = 0;
    for (int r = 0; r < 6; ++r)
      for (int c = r; c < 6; ++c, ++k) normal(r, c) = normal(c, r) = static_cast<double>(sums[k].sum());
    for (int r = 0; r < 6; ++r, ++k) right(r) = static_cast<double>(sums[k].sum());
    normal.diagonal().array() += 1e-6 * normal(0, 0);
    const double per_radius = static_cast<double>(inverse_radius_ * inverse_radius_);
    normal.diagonal().tail<3>().array() += ridge * per_radius * per_radius;
    const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> factor(normal);
    if (!(normal(0, 0) > 0) || factor.info() != Eigen::Success) return false;
    beta_ = factor.solve(right).cast<float>();
    return beta_.allFinite();
  }

  void compute_residuals() {
    for (std::size_t i = 0; i < padded_; i += 8) {
      const auto phi = features(patch_, i, inverse_radius_);
      Lane r = -lane(patch_.z, i);
      for (std::size_t k = 0; k < 6; ++k) r += beta_[static_cast<int>(k)] * phi[k];
      Eigen::Map<Lane>(residuals_.data() + i) = r.abs();
    }
  }

  /// Median of the residuals within a distance from the foot, as a standard deviation.
  float robust_scale(float reach) {
    std::size_t n = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(patch_.size); ++i)
      if (squared_distance(i) <= reach * reach) sorted_[n++] = residuals_[i];
    if (n == 0) return 0;
    const auto middle = sorted_.begin() + static_cast<std::ptrdiff_t>(n / 2);
    std::nth_element(sorted_.begin(), middle, sorted_.begin() + static_cast<std::ptrdiff_t>(n));
    return 1.4826f * *middle;
  }

  template <class Weight>
  void reweigh(float reach, Weight&& weight) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(patch_.size); ++i)
      patch_.weight[i] = squared_distance(i) <= reach * reach ? weight(residuals_[i]) : 0.0f;
  }

  Eigen::Matrix<double, 6, 1> coefficients() const {
    const double s = static_cast<double>(inverse_radius_);
    Eigen::Matrix<double, 6, 1> b = beta_.cast<double>();
    b.segment<2>(1) *= s;
    b.tail<3>() *= s * s;
    return b;
  }

 private:
  float squared_distance(std::size_t i) const {
    return patch_.x[i] * patch_.x[i] + patch_.y[i] * patch_.y[i];
  }

  Sums accumulate() const {
    Sums sums;
    sums.fill(Lane::Zero());
    for (std::size_t i = 0; i < padded_; i += 8) {
      const auto phi = features(patch_, i, inverse_radius_);
      const Lane w = lane(patch_.weight, i), z = lane(patch_.z, i);
      std::size_t k = 0;
      for (std::size_t r = 0; r < 6; ++r) {
        const Lane weighted = w * phi[r];
        for (std::size_t c = r; c < 6; ++c) sums[k++] += weighted * phi[c];
        sums[21 + r] += weighted * z;
      }
    }
    return sums;
  }

  Patch& patch_;
  float inverse_radius_;
  std::size_t padded_;
  Eigen::Matrix<float, 6, 1> beta_ = Eigen::Matrix<float, 6, 1>::Zero();
  alignas(32) Patch::Row residuals_{};
  Patch::Row sorted_{};
};

}  // namespace

double Quadric::curvature() const {
  const double mean = b[3] + b[5];
  const double difference = std::hypot(b[3] - b[5], b[4]);
  return std::max(std::abs(mean + difference), std::abs(mean - difference));
}

Quadric fit_robust_quadric(Patch& patch, const RobustOptions& options) {
  // What lies at the foot is the surface that is meant. The fit starts there and grows: a flap of tissue
  // beside it can tilt a fit over the whole patch, but not one that has to agree with the middle first.
  constexpr std::array<float, 7> kGrowth{0.4f, 0.4f, 0.55f, 0.75f, 1.0f, 1.0f, 1.0f};
  constexpr std::size_t kAbsoluteRounds = 2;
  Quadric result;
  if (patch.size < 6) return result;
  Reweighting work(patch);
  const auto floor = static_cast<float>(options.smallest_scale), cut = static_cast<float>(options.cut);
  const auto radius = static_cast<float>(patch.radius);
  work.reweigh(kGrowth[0] * radius, [](float) { return 1.0f; });
  float scale = floor;
  for (std::size_t round = 0; round < kGrowth.size(); ++round) {
    const double s = static_cast<double>(scale) / options.usual_curvature;
    if (!work.solve(s * s)) return result;
    work.compute_residuals();
    const float reach = kGrowth[std::min(round + 1, kGrowth.size() - 1)] * radius;
    if (round < kAbsoluteRounds) {
      scale = std::max(floor, work.robust_scale(kGrowth[round] * radius));
      work.reweigh(reach, [&](float r) { return scale / std::max(r, scale); });
      continue;
    }
    scale = std::max(floor, work.robust_scale(kGrowth[round] * radius));
    const float inverse = 1 / (1.25f * cut * scale);
    work.reweigh(reach, [&](float r) {
      const float u = std::max(0.0f, 1 - r * r * inverse * inverse);
      return u * u;
    });
  }
  const float limit = cut * scale;
  work.reweigh(radius, [&](float r) { return r <= limit ? 1.0f : 0.0f; });
  result.b = work.coefficients();
  result.scale = static_cast<double>(scale);
  for (int i = 0; i < patch.size; ++i) result.used += patch.weight[static_cast<std::size_t>(i)] > 0;
  return result;
}

}  // namespace linescope
