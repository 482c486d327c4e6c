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

  bool solve() {
    const Sums sums = accumulate();
    Eigen::Matrix<double, 6, 6> normal;
    Eigen::Matrix<double, 6, 1> right;
    std::size_t k = 0;
    for (int r = 0; r < 6; ++r)
      for (int c = r; c < 6; ++c, ++k) normal(r, c) = normal(c, r) = static_cast<double>(sums[k].sum());
    for (int r = 0; r < 6; ++r, ++k) right(r) = static_cast<double>(sums[k].sum());
    normal.diagonal().array() += 1e-6 * normal(0, 0);
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

  float robust_scale() {
    std::copy_n(residuals_.begin(), patch_.size, sorted_.begin());
    const auto middle = sorted_.begin() + patch_.size / 2;
    std::nth_element(sorted_.begin(), middle, sorted_.begin() + patch_.size);
    return 1.4826f * *middle;
  }

  template <class Weight>
  void reweigh(Weight&& weight) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(patch_.size); ++i)
      patch_.weight[i] = weight(residuals_[i]);
  }

  Eigen::Matrix<double, 6, 1> coefficients() const {
    const double s = static_cast<double>(inverse_radius_);
    Eigen::Matrix<double, 6, 1> b = beta_.cast<double>();
    b.segment<2>(1) *= s;
    b.tail<3>() *= s * s;
    return b;
  }

 private:
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
  Quadric result;
  if (patch.size < 6) return result;
  Reweighting work(patch);
  const auto floor = static_cast<float>(options.smallest_scale);
  const auto cut = static_cast<float>(options.cut);
  work.reweigh([](float) { return 1.0f; });
  float scale = floor;
  for (int round = 0; round < options.rounds; ++round) {
    if (!work.solve()) return result;
    work.compute_residuals();
    if (2 * round < options.rounds) {
      work.reweigh([&](float r) { return 1 / std::max(r, floor); });
      continue;
    }
    scale = std::max(floor, work.robust_scale());
    const float reach = 1 / (cut * 1.25f * scale);
    work.reweigh([&](float r) {
      const float u = std::max(0.0f, 1 - r * r * reach * reach);
      return u * u;
    });
  }
  const float limit = cut * scale;
  work.reweigh([&](float r) { return r <= limit ? 1.0f : 0.0f; });
  result.b = work.coefficients();
  result.scale = static_cast<double>(scale);
  for (int i = 0; i < patch.size; ++i) result.used += patch.weight[static_cast<std::size_t>(i)] > 0;
  return result;
}

}  // namespace linescope
