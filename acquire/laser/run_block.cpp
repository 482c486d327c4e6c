#include "acquire/laser/run_block.hpp"

#include <algorithm>

namespace linescope {

void RunBlock::begin(const PictureView& p, ProfileAxis axis, int lead) {
  const bool column = axis == ProfileAxis::column, addressable = p.stride <= INT32_MAX / p.height;
  picture = p.data;
  profiles_ = addressable ? profile_count(p, axis) : 0;
  pitch_ = column ? p.channels : p.stride;
  step = static_cast<int>(column ? p.stride : p.channels);
  for (int c = 0; c < 3; ++c) shift[static_cast<std::size_t>(c)] = p.channels == 1 ? 0 : 8 * ((lead + c) % 3);
  // Not before the picture's last pixel can four bytes reach behind it.
  end_ = p.stride * (p.height - 1) + std::ptrdiff_t{p.channels} * p.width - 3;
}

void RunBlock::collect(const RunFinder& runs, int from, int count) {
  longest = 0;
  length = {};
  count = std::min(count, profiles_ - from);
  for (int i = 0; i < count; ++i) {
    const Run only = runs.only_run(from + i);
    const int pixels = only.length();
    const std::ptrdiff_t at = pitch_ * (from + i) + std::ptrdiff_t{step} * only.first;
    if (pixels == 0 || pixels > kLongest || at + std::ptrdiff_t{step} * (pixels - 1) >= end_) continue;
    const auto lane = static_cast<std::size_t>(i);
    run[lane] = only;
    begin_at[lane] = static_cast<std::int32_t>(at);
    length[lane] = pixels;
    longest = std::max(longest, pixels);
  }
}

MeanSums mean_sums(const Profile& profile, Run run, const ColourExcess& excess, MeanLevels levels) {
  MeanSums s;
  const std::uint8_t* p = profile.at[0] + run.first * profile.step;
  const std::ptrdiff_t second = profile.at[1] - profile.at[0], third = profile.at[2] - profile.at[0];
  for (int i = run.length(); i > 0; --i, p += profile.step) {
    const int e = excess.of(p[0], p[second], p[third]);
    const int weight = e >= levels.threshold ? e : 0;
    s.saturated += p[0] >= levels.saturation ? 1 : 0;
    s.sum += weight;
    s.sums += s.sum;
    s.peak = std::max(s.peak, weight);
  }
  return s;
}

LightSums light_sums(const Profile& profile, Run run, const ColourExcess& excess, int background) {
  LightSums s;
  int at = 0;
  const std::uint8_t* p = profile.at[0] + run.first * profile.step;
  for (int i = 0; i < run.length(); ++i, p += profile.step) {
    const int light = std::max(0, *p - background);
    at = *p > s.top ? i : at;
    s.top = std::max<int>(s.top, *p);
    s.sum += light;
    s.moment += light * i;
  }
  at += run.first;
  s.excess = excess.of(s.top, profile.value(1, at), profile.value(2, at));
  return s;
}

}  // namespace linescope
