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
  const std::ptrdiff_t pitch = pitch_, end = end_;  // not read again after each lane that was written
  const int step_now = step;
  int most = 0;
  length = {};
  count = std::min(count, profiles_ - from);
  for (int i = 0; i < count; ++i) {
    const Run only = runs.only_run(from + i);
    const int pixels = only.length();
    const std::ptrdiff_t at = pitch * (from + i) + std::ptrdiff_t{step_now} * only.first;
    const bool fits = pixels > 0 && pixels <= kLongest && at + std::ptrdiff_t{step_now} * (pixels - 1) < end;
    const auto lane = static_cast<std::size_t>(i);
    run[lane] = only;
    begin_at[lane] = static_cast<std::int32_t>(at);
    length[lane] = fits ? pixels : 0;
    most = std::max(most, length[lane]);
  }
  longest = most;
}

RunMean run_mean(const Profile& profile, Run run, const ColourExcess& excess, MeanLevels levels) {
  std::int64_t sum = 0;
  std::int64_t sums = 0;  // of the sums so far: each weight as often as there are pixels from it to the end
  int peak = 1, saturated = 0;
  const std::uint8_t* p = profile.at[0] + run.first * profile.step;
  const std::ptrdiff_t second = profile.at[1] - profile.at[0], third = profile.at[2] - profile.at[0];
  for (int i = run.length(); i > 0; --i, p += profile.step) {
    const int e = excess.of(p[0], p[second], p[third]);
    const int weight = e >= levels.threshold ? e : 0;
    saturated += p[0] >= levels.saturation ? 1 : 0;
    sum += weight;
    sums += sum;
    peak = std::max(peak, weight);
  }
  const auto area = static_cast<float>(std::max<std::int64_t>(sum, 1)), height = static_cast<float>(peak);
  return {static_cast<float>(sums) / area, area / (height * kGaussArea), height,
          static_cast<float>(saturated)};
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
