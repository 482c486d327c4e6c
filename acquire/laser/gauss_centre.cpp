#include "acquire/laser/gauss_centre.hpp"

#include <algorithm>
#include <cmath>

namespace linescope {
namespace {

constexpr float kSmallest = 0.5F, kLargest = 5.2F, kRatio = 1.08F;  // sigmas of the tables, in bins
constexpr float kStep = 1.0F / 64;
constexpr float kBinned = 2.5F;  // sigma in bins that a wide line is reduced to

/// To the nearest whole number; `x` is not negative.
int nearest(float x) {
  return static_cast<int>(x + 0.5F);
}

GaussKernel kernel_of(float sigma) {
  GaussKernel k;
  k.sigma = sigma;
  k.flank_begin = nearest(3.5F * sigma);
  k.flank_end = k.flank_begin + std::max(2, static_cast<int>(1.5F * sigma));
  k.half = std::max(k.flank_end, static_cast<int>(std::ceil(3 * sigma)) + 2);
  for (int i = 0; i <= k.half; ++i)
    k.weight.push_back(std::exp(-static_cast<float>(i * i) / (2 * sigma * sigma)));
  return k;
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

GaussCentre::GaussCentre(const GaussClimber& climber) : climber_(climber) {
  for (float sigma = kSmallest; sigma < kLargest; sigma *= kRatio) {
    queues_.emplace_back();
    queues_.back().kernel = kernel_of(sigma);
  }
  for (float sigma = 0; sigma <= kLargest + kStep; sigma += kStep) {
    const float step = std::log(std::max(sigma, kSmallest) / kSmallest) / std::log(kRatio);
    index_.push_back(
        static_cast<std::uint8_t>(std::min<int>(nearest(step), static_cast<int>(queues_.size()) - 1)));
  }
}

GaussCentre::Queue& GaussCentre::queue_for(float sigma) {
  const auto step = static_cast<std::size_t>(nearest(sigma / kStep));
  return queues_[index_[std::min(step, index_.size() - 1)]];
}

void GaussCentre::begin(const PictureView& picture, ProfileAxis axis, int lead, float noise) {
  picture_ = picture;
  axis_ = axis;
  lead_ = lead;
  noise_ = noise;
  const Profile p = profile_of(picture, axis, lead, 0);
  step_ = p.step;
  pitch_ = axis == ProfileAxis::column ? picture.channels : picture.stride;
  // Of the last three even grey pixels may lie less than four bytes before the picture's end. Where bytes
  // cannot be counted in 32 bits, no window is plain.
  safe_profiles_ = profile_count(picture, axis) - 3;
  plain_end_ = picture.stride <= INT32_MAX / picture.height ? p.length : 0;
  fits_.clear();
}

void GaussCentre::add(int profile, float start, float sigma, const LightMix& mix) {
  const int bin = sigma < 2 * kBinned ? 1 : static_cast<int>(sigma / kBinned);
  Queue& queue = queue_for(bin == 1 ? sigma : sigma / static_cast<float>(bin));
  const int half = queue.kernel.half;
  Waiting& w = queue.waiting[queue.count++];  // field by field: a copy would wait for them
  w.profile = profile;
  w.fit = fits_.size();
  w.frame.first = nearest(start) - half * bin - bin / 2;
  w.frame.bin = bin;
  w.frame.half = half;
  w.mix = mix;
  fits_.push_back({start, 0, false});
  if (queue.count == kGaussLanes) climb(queue);
}

const std::vector<GaussFit>& GaussCentre::fits() {
  for (Queue& queue : queues_)
    if (queue.count > 0) climb(queue);
  return fits_;
}

/// The laser's channel alone, pixel by pixel, inside the profile; also the four bytes that are read at its
/// last pixel lie in the picture.
bool GaussCentre::plain(const Waiting& w) const {
  const int end = w.frame.first + 2 * w.frame.half + 1;
  return w.frame.bin == 1 && w.mix[0] == 0 && w.mix[1] == 0 && w.frame.first >= 0 &&
         end <= plain_end_ - (w.profile >= safe_profiles_ ? 4 : 0);
}

/// Averages of `bin` pixels each; behind the ends of the profile the last pixel goes on. The first channel
/// begins the window, the others are added to it.
void GaussCentre::gather_slowly(const Waiting& w, std::size_t lane) {
  const Profile p = profile_of(picture_, axis_, lead_, w.profile);
  for (int i = 0; i <= 2 * w.frame.half; ++i) batch_.window[static_cast<std::size_t>(i)][lane] = 0;
  add_channel(p, w.frame, 0, 1.0F, lane);
  if (w.mix[0] != 0) add_channel(p, w.frame, 1, w.mix[0], lane);
  if (w.mix[1] != 0) add_channel(p, w.frame, 2, w.mix[1], lane);
}

void GaussCentre::add_channel(const Profile& p, const Frame& f, std::size_t channel, float share,
                              std::size_t lane) {
  const std::uint8_t* const base = p.at[channel];
  const float scale = share / static_cast<float>(f.bin);
  for (int i = 0; i <= 2 * f.half; ++i) {
    int total = 0;
    for (int k = f.first + i * f.bin; k < f.first + (i + 1) * f.bin; ++k)
      total += base[std::clamp(k, 0, p.length - 1) * p.step];
    batch_.window[static_cast<std::size_t>(i)][lane] += scale * static_cast<float>(total);
  }
}

void GaussCentre::climb(Queue& queue) {
  GaussWindows windows;
  windows.picture = picture_.data + (picture_.channels == 1 ? 0 : lead_);
  windows.step = static_cast<int>(step_);
  for (std::size_t lane = 0; lane < queue.count; ++lane) {
    const Waiting& w = queue.waiting[lane];
    if (!plain(w)) continue;
    windows.first[lane] = static_cast<std::int32_t>(pitch_ * w.profile + step_ * w.frame.first);
    windows.wanted[lane] = -1;
  }
  climber_.gather(windows, 2 * queue.kernel.half + 1, batch_);
  for (std::size_t lane = 0; lane < queue.count; ++lane) {
    const Waiting& w = queue.waiting[lane];
    if (windows.wanted[lane] == 0) gather_slowly(w, lane);
    batch_.start[lane] = w.frame.index_of(fits_[w.fit].centre);
  }
  climber_.climb(queue.kernel, noise_, batch_);
  for (std::size_t lane = 0; lane < queue.count; ++lane) {
    const Waiting& w = queue.waiting[lane];
    if (batch_.settled[lane] != 0)
      fits_[w.fit] = {w.frame.px_of(batch_.place[lane]), batch_.amplitude[lane], true};
  }
  queue.count = 0;
}

}  // namespace linescope
