#include "acquire/laser/gauss_centre.hpp"

#include <algorithm>
#include <cmath>

namespace linescope {
namespace {

constexpr float kSmallest = 0.5F, kLargest = 5.2F, kRatio = 1.08F;  // sigmas of the tables, in bins
constexpr float kStep = 1.0F / 64;
constexpr float kBinned = 2.5F;    // sigma in bins that a wide line is reduced to
constexpr float kFarthest = 2.0F;  // sigmas from the start beyond which it has wandered off

/// To the nearest whole number; `x` is not negative.
int nearest(float x) {
  return static_cast<int>(x + 0.5F);
}

/// Of four numbers within +-6, to a millionth.
template <class Lanes>
Lanes exponential(Lanes x) {
  x *= 1.0F / 16;
  Lanes e = 1 + x * (1.0F / 6);
  for (const float divisor : {1.0F / 5, 1.0F / 4, 1.0F / 3, 1.0F / 2, 1.0F}) e = 1 + x * divisor * e;
  for (int i = 0; i < 4; ++i) e *= e;
  return e;
}

}  // namespace

float GaussCentre::Frame::index_of(float px) const {
  const auto width = static_cast<float>(bin);
  return (px - static_cast<float>(first) - 0.5F * (width - 1)) / width - static_cast<float>(half);
}

float GaussCentre::Frame::px_of(float index) const {
  const auto width = static_cast<float>(bin);
  return static_cast<float>(first) + (index + static_cast<float>(half)) * width + 0.5F * (width - 1);
}

GaussCentre::GaussCentre() {
  for (float sigma = kSmallest; sigma < kLargest; sigma *= kRatio) {
    Kernel k;
    k.sigma = sigma;
    k.flank_begin = nearest(3.5F * sigma);
    k.flank_end = k.flank_begin + std::max(2, static_cast<int>(1.5F * sigma));
    k.half = std::max(k.flank_end, static_cast<int>(std::ceil(3 * sigma)) + 2);
    for (int i = 0; i <= k.half; ++i)
      k.weight.push_back(std::exp(-static_cast<float>(i * i) / (2 * sigma * sigma)));
    kernels_.push_back(std::move(k));
  }
  for (float sigma = 0; sigma <= kLargest + kStep; sigma += kStep) {
    const float step = std::log(std::max(sigma, kSmallest) / kSmallest) / std::log(kRatio);
    index_.push_back(
        static_cast<std::uint8_t>(std::min<int>(nearest(step), static_cast<int>(kernels_.size()) - 1)));
  }
  window_.resize(static_cast<std::size_t>(2 * kernels_.back().half + 1));
}

const GaussCentre::Kernel& GaussCentre::kernel_for(float sigma) const {
  const auto step = static_cast<std::size_t>(nearest(sigma / kStep));
  return kernels_[index_[std::min(step, index_.size() - 1)]];
}

void GaussCentre::begin(float noise) {
  noise_ = noise;
  waiting_ = 0;
  fits_.clear();
}

void GaussCentre::add(const Profile& profile, float start, float sigma, const LightMix& mix) {
  const int bin = std::max(1, static_cast<int>(sigma / kBinned));
  const Kernel& kernel = kernel_for(sigma / static_cast<float>(bin));
  if (waiting_ == kLanes || (waiting_ > 0 && &kernel != kernel_)) climb();
  kernel_ = &kernel;
  Frame& frame = frames_[waiting_];
  frame = {nearest(start) - kernel.half * bin - bin / 2, bin, kernel.half};
  start_[waiting_] = frame.index_of(start);
  gather(profile, frame, 0, 1.0F);
  if (mix[0] != 0) gather(profile, frame, 1, mix[0]);
  if (mix[1] != 0) gather(profile, frame, 2, mix[1]);
  fits_.push_back({start, 0, false});
  ++waiting_;
}

const std::vector<GaussFit>& GaussCentre::fits() {
  if (waiting_ > 0) climb();
  return fits_;
}

/// Averages of `bin` pixels each; behind the ends of the profile the last pixel goes on. The first channel
/// begins the window, the others are added to it.
void GaussCentre::gather(const Profile& p, const Frame& f, std::size_t channel, float share) {
  const std::uint8_t* const base = p.at[channel];
  float* out = reinterpret_cast<float*>(window_.data()) + waiting_;
  const int count = 2 * f.half + 1;
  const bool inside = f.first >= 0 && f.first + count * f.bin <= p.length;
  if (inside && f.bin == 1 && channel == 0) {
    const std::uint8_t* next = base + f.first * p.step;
    for (int i = 0; i < count; ++i, next += p.step, out += kLanes) *out = static_cast<float>(*next);
    return;
  }
  const float scale = share / static_cast<float>(f.bin);
  for (int i = 0; i < count; ++i, out += kLanes) {
    int total = 0;
    for (int k = f.first + i * f.bin; k < f.first + (i + 1) * f.bin; ++k)
      total += base[std::clamp(k, 0, p.length - 1) * p.step];
    *out = (channel == 0 ? 0 : *out) + scale * static_cast<float>(total);
  }
}

/// The level of both flanks; a slope only where the noise does not explain it.
void GaussCentre::take_background_out() {
  const Kernel& k = *kernel_;
  Lanes* const middle = window_.data() + k.half;
  Lanes left{}, right{};
  for (int d = k.flank_begin; d <= k.flank_end; ++d) {
    left += middle[-d];
    right += middle[d];
  }
  const float share = 1.0F / static_cast<float>(k.flank_end - k.flank_begin + 1);
  const Lanes rise = (right - left) * share, level = 0.5F * share * (left + right);
  const Lanes slope = rise * rise > 18 * noise_ * noise_ * share
                          ? rise / static_cast<float>(k.flank_begin + k.flank_end)
                          : Lanes{};
  for (int d = -k.half; d <= k.half; ++d) middle[d] -= level + slope * static_cast<float>(d);
}

GaussCentre::Light GaussCentre::below(Lanes place) const {
  const Kernel& k = *kernel_;
  const Lanes* const middle = window_.data() + k.half;
  // exp(-(d - place)^2 / 2 s^2) is exp(-d^2 / 2 s^2), a table, times exp(place / s^2) to the power of d,
  // times what all weights have in common.
  const Lanes up = exponential(place / (k.sigma * k.sigma)), down = 1 / up;
  Lanes rising = up, falling = down;
  Light sum{middle[0], {}, Lanes{} + 1};
  for (int d = 1; d <= k.half; ++d, rising *= up, falling *= down) {
    const float weight = k.weight[static_cast<std::size_t>(d)];
    const Lanes above = weight * rising, beneath = weight * falling;
    const Lanes a = above * middle[d], b = beneath * middle[-d];
    sum.weight += a + b;
    sum.moment += (a - b) * static_cast<float>(d);
    sum.power += above * above + beneath * beneath;
  }
  return sum;
}

/// Moves the Gaussians to where the light below them, less the background, is balanced.
void GaussCentre::climb() {
  constexpr int kMostRounds = 6;
  const Kernel& k = *kernel_;
  const float enough = std::max(1.0F / 16, 0.05F * k.sigma), farthest = kFarthest * k.sigma;
  take_background_out();
  GaussFit* const out = fits_.data() + fits_.size() - waiting_;
  Lanes at = start_;
  unsigned open = (1U << waiting_) - 1;
  for (int round = 0; round < kMostRounds && open != 0; ++round) {
    const Lanes place = at;
    const Light light = below(place);
    // Line and kernel are equally wide: the mean sees half of the offset.
    const Lanes offset = 2 * (light.moment / light.weight - place);
    for (std::size_t lane = 0; lane < waiting_; ++lane) {
      if ((open >> lane & 1U) == 0) continue;
      at[lane] += std::clamp(offset[lane], -k.sigma, k.sigma);
      const bool lost = !(light.weight[lane] > 0) || !(std::abs(at[lane] - start_[lane]) <= farthest);
      if (!lost && std::abs(offset[lane]) > enough) continue;
      open &= ~(1U << lane);
      if (lost) {
        at[lane] = start_[lane];
        continue;
      }
      const float common = std::exp(-place[lane] * place[lane] / (2 * k.sigma * k.sigma));
      out[lane] = {frames_[lane].px_of(at[lane]), light.weight[lane] / (common * light.power[lane]), true};
    }
  }
  waiting_ = 0;
}

}  // namespace linescope
