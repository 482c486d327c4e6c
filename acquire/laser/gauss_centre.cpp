#include "acquire/laser/gauss_centre.hpp"

#include <algorithm>
#include <cmath>

namespace linescope {
namespace {

constexpr float kSmallest = 0.5F, kLargest = 5.2F, kRatio = 1.08F;  // sigmas of the tables, in bins
constexpr float kBinned = 2.5F;  // sigma in bins that a wide line is reduced to
constexpr int kLanes = 4;        // sums run in four lanes, which compilers turn into one vector

struct Sums {
  float weight = 0, moment = 0;
};

Sums correlate(const float* light, const float* weight, const float* moment, std::size_t n) {
  std::array<float, kLanes> w{}, m{};
  for (std::size_t i = 0; i < n; i += kLanes) {
    for (std::size_t k = 0; k < kLanes; ++k) {
      w[k] += light[i + k] * weight[i + k];
      m[k] += light[i + k] * moment[i + k];
    }
  }
  return {(w[0] + w[1]) + (w[2] + w[3]), (m[0] + m[1]) + (m[2] + m[3])};
}

std::size_t padded_taps(int radius) {
  const auto taps = static_cast<std::size_t>(2 * radius + 1);
  return (taps + kLanes - 1) / kLanes * kLanes;
}

}  // namespace

GaussCentre::GaussCentre() {
  for (float sigma = kSmallest; sigma < kLargest; sigma *= kRatio) {
    Kernel k;
    k.sigma = sigma;
    k.radius = static_cast<int>(std::ceil(3 * sigma));
    const std::size_t taps = padded_taps(k.radius);
    k.weight.assign(kPhases * taps, 0);
    k.moment.assign(kPhases * taps, 0);
    for (std::size_t phase = 0; phase < kPhases; ++phase) {
      for (int i = -k.radius; i <= k.radius; ++i) {
        const float t = static_cast<float>(i) - static_cast<float>(phase) / kPhases;
        const float w = std::exp(-t * t / (2 * sigma * sigma));
        const std::size_t at = phase * taps + static_cast<std::size_t>(i + k.radius);
        k.weight[at] = w;
        k.moment[at] = w * t;
        k.power[phase] += w * w;
      }
    }
    kernels_.push_back(std::move(k));
  }
}

const GaussCentre::Kernel& GaussCentre::kernel_for(float sigma) const {
  const float step = std::log(std::max(sigma, kSmallest) / kSmallest) / std::log(kRatio);
  const auto index = static_cast<std::size_t>(step + 0.5F);
  return kernels_[std::min(index, kernels_.size() - 1)];
}

/// Averages of `bin` pixels each; behind the ends of the profile the last pixel goes on.
void GaussCentre::gather(const Profile& p, int first, int count, int bin, const LightMix& mix) {
  window_.assign(static_cast<std::size_t>(count) + kLanes, 0);
  const bool inside = first >= 0 && first + count * bin <= p.length;
  const std::array share{1.0F, mix[0], mix[1]};
  for (std::size_t c = 0; c < 3; ++c) {
    if (share[c] == 0) continue;
    const std::uint8_t* const base = p.at[c];
    const float scale = share[c] / static_cast<float>(bin);
    for (int i = 0; i < count; ++i) {
      int sum = 0;
      for (int k = first + i * bin; k < first + (i + 1) * bin; ++k) {
        sum += base[(inside ? k : std::clamp(k, 0, p.length - 1)) * p.step];
      }
      window_[static_cast<std::size_t>(i)] += scale * static_cast<float>(sum);
    }
  }
}

/// Level of both flanks, `flank_begin` to `flank_end` bins from the middle; a slope only where the noise does
/// not explain it.
void GaussCentre::subtract_background(int flank_begin, int flank_end, float middle, float noise) {
  const int last = static_cast<int>(window_.size()) - kLanes - 1, at = static_cast<int>(middle + 0.5F);
  float left = 0, right = 0;
  int n_left = 0, n_right = 0;
  for (int d = flank_begin; d <= flank_end; ++d) {
    if (at - d >= 0) left += window_[static_cast<std::size_t>(at - d)], ++n_left;
    if (at + d <= last) right += window_[static_cast<std::size_t>(at + d)], ++n_right;
  }
  if (n_left == 0 || n_right == 0) return;
  left /= static_cast<float>(n_left);
  right /= static_cast<float>(n_right);
  const float mean = 0.5F * (left + right);
  const float step = right - left,
              doubt = 3 * noise * std::sqrt(2.0F / static_cast<float>(std::min(n_left, n_right)));
  const float slope = std::abs(step) > doubt ? step / static_cast<float>(flank_begin + flank_end) : 0;
  for (int i = 0; i <= last; ++i)
    window_[static_cast<std::size_t>(i)] -= mean + slope * static_cast<float>(i - at);
}

GaussFit GaussCentre::fit(const Profile& profile, float start, float sigma, float noise,
                          const LightMix& mix) {
  const int bin = std::max(1, static_cast<int>(sigma / kBinned));
  const float in_bins = sigma / static_cast<float>(bin);
  const Kernel& kernel = kernel_for(in_bins);
  const int flank_begin = static_cast<int>(std::ceil(3.5F * in_bins)),
            flank_end = flank_begin + static_cast<int>(std::ceil(1.5F * in_bins));
  const int half = std::max(flank_end, kernel.radius + 2) + 1;
  const int first = static_cast<int>(std::lround(start)) - half * bin - bin / 2;
  gather(profile, first, 2 * half + 1, bin, mix);
  const auto index_of = [&](float px) {
    return (px - static_cast<float>(first) - 0.5F * static_cast<float>(bin - 1)) / static_cast<float>(bin);
  };
  subtract_background(flank_begin, flank_end, index_of(start), noise);

  GaussFit fit{start, 0, false};
  const std::size_t taps = padded_taps(kernel.radius);
  float at = index_of(start);
  const float begin = at;
  for (int round = 0; round < 6; ++round) {
    const int ticks = static_cast<int>(std::lround(at * kPhases));
    const int base = ticks / kPhases - kernel.radius;
    const auto phase = static_cast<std::size_t>(ticks % kPhases);
    if (ticks < 0 || base < 0 || base + static_cast<int>(taps) > static_cast<int>(window_.size())) return fit;
    const Sums s = correlate(window_.data() + base, kernel.weight.data() + phase * taps,
                             kernel.moment.data() + phase * taps, taps);
    if (!(s.weight > 0)) return fit;
    // Line and kernel are equally wide: the mean sees half of the offset.
    const float offset = 2 * s.moment / s.weight;
    at = static_cast<float>(ticks) / kPhases + std::clamp(offset, -in_bins, in_bins);
    fit.amplitude = s.weight / kernel.power[phase];
    if (round > 0 && std::abs(offset) < 1.0F / kPhases) {
      fit.settled = std::abs(at - begin) <= 2 * in_bins;
      break;
    }
  }
  if (fit.settled)
    fit.centre =
        static_cast<float>(first) + 0.5F * static_cast<float>(bin - 1) + at * static_cast<float>(bin);
  return fit;
}

}  // namespace linescope
