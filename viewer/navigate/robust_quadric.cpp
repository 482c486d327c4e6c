#include "viewer/navigate/robust_quadric.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <bit>
#include <bitset>
#include <cmath>

#include "common/processor.hpp"

namespace linescope {
namespace {

#if defined(__x86_64__) && defined(__GNUC__)
#define LINESCOPE_QUADRIC_AVX2 1
#endif
#define LINESCOPE_INLINE inline __attribute__((always_inline))

/// Eight segments at a time; the compiler splits it where registers are shorter.
using Lane = float __attribute__((vector_size(32), aligned(4), may_alias));
using Solution = std::array<float, 6>;
using Sums = std::array<double, 27>;  // upper triangle of the 6 x 6 normal matrix, then the right side

LINESCOPE_INLINE const Lane& lane(const Patch::Row& row, std::size_t i) {
  return *reinterpret_cast<const Lane*>(row.data() + i);
}

/// A segment's mean height is the mean of the surface over the segment, hence the squared spreads.
LINESCOPE_INLINE void features(const Patch& patch, std::size_t i, float inverse_radius, Lane (&phi)[6]) {
  const Lane x = lane(patch.x, i) * inverse_radius, y = lane(patch.y, i) * inverse_radius;
  const Lane sx = lane(patch.sx, i) * inverse_radius, sy = lane(patch.sy, i) * inverse_radius;
  phi[0] = x - x + 1.0f;
  phi[1] = x;
  phi[2] = y;
  phi[3] = x * x + sx * sx;
  phi[4] = x * y + sx * sy;
  phi[5] = y * y + sy * sy;
}

LINESCOPE_INLINE void accumulate_body(const Patch& patch, std::size_t padded, float inverse_radius,
                                      Sums& sums) {
  Lane lanes[27];
  for (Lane& l : lanes) l = Lane{};
  for (std::size_t i = 0; i < padded; i += 8) {
    Lane phi[6];
    features(patch, i, inverse_radius, phi);
    const Lane w = lane(patch.weight, i), z = lane(patch.z, i);
    int k = 0;
    for (int r = 0; r < 6; ++r) {
      const Lane weighted = w * phi[r];
      for (int c = r; c < 6; ++c) lanes[k++] += weighted * phi[c];
      lanes[21 + r] += weighted * z;
    }
  }
  for (int k = 0; k < 27; ++k) {
    double sum = 0;
    for (int j = 0; j < 8; ++j) sum += static_cast<double>(lanes[k][j]);
    sums[static_cast<std::size_t>(k)] = sum;
  }
}

LINESCOPE_INLINE void residuals_body(const Patch& patch, std::size_t padded, float inverse_radius,
                                     const Solution& b, Patch::Row& residuals) {
  for (std::size_t i = 0; i < padded; i += 8) {
    Lane phi[6];
    features(patch, i, inverse_radius, phi);
    Lane r = -lane(patch.z, i);
    for (std::size_t k = 0; k < 6; ++k) r += b[k] * phi[k];
    *reinterpret_cast<Lane*>(residuals.data() + i) = r < 0 ? -r : r;
  }
}

void accumulate_portable(const Patch& patch, std::size_t padded, float inverse_radius, Sums& sums) {
  accumulate_body(patch, padded, inverse_radius, sums);
}
void residuals_portable(const Patch& patch, std::size_t padded, float inverse_radius, const Solution& b,
                        Patch::Row& out) {
  residuals_body(patch, padded, inverse_radius, b, out);
}

#ifdef LINESCOPE_QUADRIC_AVX2
__attribute__((target("avx2,fma"))) void accumulate_avx2(const Patch& patch, std::size_t padded,
                                                         float inverse_radius, Sums& sums) {
  accumulate_body(patch, padded, inverse_radius, sums);
}
__attribute__((target("avx2,fma"))) void residuals_avx2(const Patch& patch, std::size_t padded,
                                                        float inverse_radius, const Solution& b,
                                                        Patch::Row& out) {
  residuals_body(patch, padded, inverse_radius, b, out);
}
#endif

struct Kernels {
  decltype(&accumulate_portable) accumulate = accumulate_portable;
  decltype(&residuals_portable) residuals = residuals_portable;
};

Kernels kernels(bool allow_simd) {
#ifdef LINESCOPE_QUADRIC_AVX2
  if (allow_simd && has_avx2_and_fma()) return {accumulate_avx2, residuals_avx2};
#endif
  (void)allow_simd;
  return {};
}

/// Lines share their errors, so few lines follow a bent fit more closely than they should: what a fit that
/// takes three of them away leaves, brought back to size.
float shrinkage(float lines) {
  return std::sqrt(lines / std::max(lines - 3, 0.25f * lines));
}

/// Eight segments at a time, in single precision: this only decides what belongs to the surface.
class Reweighting {
 public:
  Reweighting(Patch& patch, const Kernels& use)
      : kernels_(use),
        patch_(patch),
        inverse_radius_(static_cast<float>(1 / patch.radius)),
        padded_(static_cast<std::size_t>((patch.size + 7) / 8 * 8)) {
    // Padding up to a multiple of eight with segments of no weight.
    for (auto i = static_cast<std::size_t>(patch.size); i < padded_; ++i)
      patch.x[i] = patch.y[i] = patch.z[i] = patch.sx[i] = patch.sy[i] = patch.weight[i] = 0;
  }

  /// `ridge`: how strongly curvature is held back, in units of weight times mm^2 (a segment weighs 1).
  bool solve(double ridge) {
    Sums sums;
    kernels_.accumulate(patch_, padded_, inverse_radius_, sums);
    Eigen::Matrix<double, 6, 6> normal;
    Eigen::Matrix<double, 6, 1> right;
    std::size_t k = 0;
    for (int r = 0; r < 6; ++r)
      for (int c = r; c < 6; ++c, ++k) normal(r, c) = normal(c, r) = sums[k];
    for (int r = 0; r < 6; ++r, ++k) right(r) = sums[k];
    normal.diagonal().array() += 1e-6 * normal(0, 0);
    const double per_radius = static_cast<double>(inverse_radius_ * inverse_radius_);
    normal.diagonal().tail<3>().array() += ridge * per_radius * per_radius;
    const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> factor(normal);
    if (!(normal(0, 0) > 0) || factor.info() != Eigen::Success) return false;
    const Eigen::Matrix<double, 6, 1> solution = factor.solve(right);
    for (int i = 0; i < 6; ++i) beta_[static_cast<std::size_t>(i)] = static_cast<float>(solution[i]);
    return solution.allFinite();
  }

  void compute_residuals() { kernels_.residuals(patch_, padded_, inverse_radius_, beta_, residuals_); }

  /// Median of the residuals within a distance from the foot, as a standard deviation; by counting in bins an
  /// eighth of an octave wide (exponent and three bits of a float), within a per cent or so.
  float robust_scale(float reach) const {
    constexpr std::uint32_t kLowest = 112u << 3;  // 2^-15 mm
    constexpr std::uint32_t kBins = 24u << 3;
    std::array<std::uint16_t, kBins> bins{};
    std::bitset<Patch::kMostLines> lines;
    int n = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(patch_.size); ++i) {
      if (squared_distance(i) > reach * reach) continue;
      lines.set(patch_.line[i]);
      const std::uint32_t bin = std::bit_cast<std::uint32_t>(residuals_[i]) >> 20;
      ++bins[std::clamp(bin, kLowest, kLowest + kBins - 1) - kLowest];
      ++n;
    }
    int below = 0;
    std::uint32_t bin = 0;
    while (bin + 1 < kBins && 2 * (below + bins[bin]) < n) below += bins[bin++];
    const auto low = std::bit_cast<float>((bin + kLowest) << 20),
               high = std::bit_cast<float>((bin + 1 + kLowest) << 20);
    const float share = bins[bin] > 0 ? (0.5f * static_cast<float>(n) - static_cast<float>(below)) /
                                            static_cast<float>(bins[bin])
                                      : 0.0f;
    return shrinkage(static_cast<float>(lines.count())) * 1.4826f * (low + share * (high - low));
  }

  template <class Weight>
  void reweigh(float reach, Weight&& weight) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(patch_.size); ++i)
      patch_.weight[i] = squared_distance(i) <= reach * reach ? weight(residuals_[i]) : 0.0f;
  }

  Eigen::Matrix<double, 6, 1> coefficients() const {
    const double s = static_cast<double>(inverse_radius_);
    Eigen::Matrix<double, 6, 1> b = Eigen::Map<const Eigen::Matrix<float, 6, 1>>(beta_.data()).cast<double>();
    b.segment<2>(1) *= s;
    b.tail<3>() *= s * s;
    return b;
  }

 private:
  float squared_distance(std::size_t i) const {
    return patch_.x[i] * patch_.x[i] + patch_.y[i] * patch_.y[i];
  }

  Kernels kernels_;
  Patch& patch_;
  float inverse_radius_;
  std::size_t padded_;
  Solution beta_{};
  alignas(32) Patch::Row residuals_;
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
  constexpr std::array<float, 6> kGrowth{0.4f, 0.4f, 0.6f, 0.8f, 1.0f, 1.0f};
  constexpr std::size_t kAbsoluteRounds = 2;
  Quadric result;
  if (patch.size < 6) return result;
  Reweighting work(patch, kernels(options.allow_simd));
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
    // The noise does not grow with the patch; what makes it seem to is something else that came in.
    const float found = work.robust_scale(kGrowth[round] * radius);
    scale = std::max(floor, std::min(found, 1.2f * scale));
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
