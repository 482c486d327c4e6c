#include "acquire/laser/gauss_centre.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace linescope {
namespace {

constexpr float kSmallest = 0.5F, kLargest = 5.2F, kRatio = 1.08F;  // sigmas of the tables, in bins
constexpr float kStep = 1.0F / 64;
constexpr float kBinned = 2.5F;  // sigma in bins that a wide line is reduced to
constexpr std::size_t kLanes = 4;
using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));

Lanes load(const float* p) {
  Lanes v;
  std::memcpy(&v, p, sizeof(v));
  return v;
}

float sum(Lanes v) {
  return (v[0] + v[1]) + (v[2] + v[3]);
}

struct Sums {
  float weight = 0, moment = 0;
};

Sums correlate(const float* light, const float* weight, const float* moment, std::size_t n) {
  Lanes w{}, m{};
  for (std::size_t i = 0; i < n; i += kLanes) {
    const Lanes l = load(light + i);
    w += l * load(weight + i);
    m += l * load(moment + i);
  }
  return {sum(w), sum(m)};
}

/// To the nearest whole number; `x` is not negative.
int nearest(float x) {
  return static_cast<int>(x + 0.5F);
}

}  // namespace

GaussCentre::GaussCentre() {
  for (float sigma = kSmallest; sigma < kLargest; sigma *= kRatio) {
    Kernel k;
    k.sigma = sigma;
    k.radius = static_cast<int>(std::ceil(3 * sigma));
    k.taps = (static_cast<std::size_t>(2 * k.radius + 1) + kLanes - 1) / kLanes * kLanes;
    k.weight.assign(kPhases * k.taps, 0);
    k.moment.assign(kPhases * k.taps, 0);
    for (std::size_t phase = 0; phase < kPhases; ++phase) {
      for (int i = -k.radius; i <= k.radius; ++i) {
        const float t = static_cast<float>(i) - static_cast<float>(phase) / kPhases;
        const float w = std::exp(-t * t / (2 * sigma * sigma));
        const std::size_t at = phase * k.taps + static_cast<std::size_t>(i + k.radius);
        k.weight[at] = w;
        k.moment[at] = w * t;
        Kernel::Totals& total = k.totals[phase];
        total.weight += w;
        total.moment += w * t;
        total.spread += w * t * t;
        total.power += w * w;
      }
    }
    kernels_.push_back(std::move(k));
  }
  for (float sigma = 0; sigma <= kLargest + kStep; sigma += kStep) {
    const float step = std::log(std::max(sigma, kSmallest) / kSmallest) / std::log(kRatio);
    index_.push_back(
        static_cast<std::uint8_t>(std::min<int>(nearest(step), static_cast<int>(kernels_.size()) - 1)));
  }
}

const GaussCentre::Kernel& GaussCentre::kernel_for(float sigma) const {
  const auto step = static_cast<std::size_t>(nearest(sigma / kStep));
  return kernels_[index_[std::min(step, index_.size() - 1)]];
}

GaussCentre::Frame GaussCentre::frame_for(const Kernel& kernel, float start, int bin) const {
  Frame f;
  f.bin = bin;
  f.begin = nearest(3.5F * kernel.sigma);
  f.end = f.begin + std::max(2, static_cast<int>(1.5F * kernel.sigma));
  const int half = std::max(f.end, kernel.radius + 2);
  f.count = 2 * half + 1;
  f.first = nearest(start) - half * bin - bin / 2;
  return f;
}

bool GaussCentre::take(const StoredLight& stored, const Frame& f) {
  const int from = f.first - stored.begin;
  if (f.bin != 1 || from < 0 || from + f.count > static_cast<int>(stored.values.size())) return false;
  const std::int16_t* light = stored.values.data() + from;
  for (int i = 0; i < f.count; ++i) window_[static_cast<std::size_t>(i)] = static_cast<float>(light[i]);
  return true;
}

/// Averages of `bin` pixels each; behind the ends of the profile the last pixel goes on.
void GaussCentre::gather(const Profile& p, const Frame& f, const LightMix& mix) {
  std::fill_n(window_.begin(), f.count, 0.0F);
  add_channel(p, f, 0, 1.0F);
  if (mix[0] != 0) add_channel(p, f, 1, mix[0]);
  if (mix[1] != 0) add_channel(p, f, 2, mix[1]);
}

void GaussCentre::add_channel(const Profile& p, const Frame& f, std::size_t channel, float share) {
  const std::uint8_t* const base = p.at[channel];
  float* out = window_.data();
  const bool inside = f.first >= 0 && f.first + f.count * f.bin <= p.length;
  if (inside && f.bin == 1) {
    const std::uint8_t* next = base + f.first * p.step;
    for (int i = 0; i < f.count; ++i, next += p.step) out[i] += share * static_cast<float>(*next);
    return;
  }
  const float scale = share / static_cast<float>(f.bin);
  for (int i = 0; i < f.count; ++i) {
    int total = 0;
    for (int k = f.first + i * f.bin; k < f.first + (i + 1) * f.bin; ++k)
      total += base[std::clamp(k, 0, p.length - 1) * p.step];
    out[i] += scale * static_cast<float>(total);
  }
}

/// Level of both flanks; a slope only where the noise does not explain it.
GaussCentre::Background GaussCentre::background(const Frame& f, float middle, float noise) const {
  const int at = nearest(middle), n = f.end - f.begin + 1;
  const float* w = window_.data() + at;
  float left = 0, right = 0;
  for (int d = f.begin; d <= f.end; ++d) {
    left += w[-d];
    right += w[d];
  }
  const float share = 1.0F / static_cast<float>(n), rise = (right - left) * share;
  const bool real = rise * rise > 9 * noise * noise * 2 * share;
  const float slope = real ? rise / static_cast<float>(f.begin + f.end) : 0;
  return {0.5F * (left + right) * share - slope * static_cast<float>(at), slope};
}

/// Moves the Gaussian to where the light below it, less the background, is balanced.
GaussFit GaussCentre::climb(const Kernel& kernel, const Frame& f, const Background& b, float start) const {
  constexpr int kMostRounds = 6;
  GaussFit fit{start, 0, false};
  const float begin = f.index_of(start), enough = std::max(1.0F / kPhases, 0.05F * kernel.sigma);
  float at = begin;
  for (int round = 0; round < kMostRounds; ++round) {
    const int ticks = at < 0 ? -1 : nearest(at * kPhases), first = ticks / kPhases - kernel.radius;
    if (ticks < 0 || first < 0 || first + 2 * kernel.radius >= f.count) return fit;
    const auto phase = static_cast<std::size_t>(ticks % kPhases);
    const Kernel::Totals& total = kernel.totals[phase];
    const std::size_t row = phase * kernel.taps;
    const Sums s = correlate(window_.data() + first, kernel.weight.data() + row, kernel.moment.data() + row,
                             kernel.taps);
    const float place = static_cast<float>(ticks) / kPhases, level = b.level + b.slope * place;
    const float weight = s.weight - level * total.weight - b.slope * total.moment;
    const float moment = s.moment - level * total.moment - b.slope * total.spread;
    if (!(weight > 0)) return fit;
    // Line and kernel are equally wide: the mean sees half of the offset.
    const float offset = 2 * moment / weight;
    at = place + std::clamp(offset, -kernel.sigma, kernel.sigma);
    if (std::abs(offset) > enough) continue;
    fit.amplitude = weight / total.power;
    fit.settled = std::abs(at - begin) <= 2 * kernel.sigma;
    if (fit.settled) fit.centre = f.px_of(at);
    return fit;
  }
  return fit;
}

GaussFit GaussCentre::fit(const Profile& profile, float start, float sigma, float noise, const LightMix& mix,
                          const StoredLight& stored) {
  const int bin = std::max(1, static_cast<int>(sigma / kBinned));
  const Kernel& kernel = kernel_for(sigma / static_cast<float>(bin));
  const Frame frame = frame_for(kernel, start, bin);
  const auto room = static_cast<std::size_t>(frame.count) + kLanes;
  if (window_.size() < room) window_.resize(room);
  if (!take(stored, frame)) gather(profile, frame, mix);
  std::fill_n(window_.begin() + frame.count, kLanes, 0.0F);
  return climb(kernel, frame, background(frame, frame.index_of(start), noise), start);
}

}  // namespace linescope
