#include "acquire/laser/run_block.hpp"

#include <algorithm>
#include <cstdlib>

namespace linescope {

void RunBlock::collect(const PictureView& p, ProfileAxis axis, int lead, const RunFinder& runs, int from,
                       int count) {
  const bool column = axis == ProfileAxis::column, grey = p.channels == 1;
  const std::ptrdiff_t pitch = column ? p.channels : p.stride, along = column ? p.stride : p.channels;
  // Not before the last pixel can four bytes reach behind the picture.
  const std::ptrdiff_t end = p.stride * (p.height - 1) + std::ptrdiff_t{p.channels} * p.width - 4;
  const bool addressable = std::abs(p.stride) <= INT32_MAX / p.height;
  first = from;
  picture = p.data;
  step = static_cast<int>(along);
  for (int c = 0; c < 3; ++c) shift[static_cast<std::size_t>(c)] = grey ? 0 : 8 * ((lead + c) % 3);
  longest = 0;
  length = {};
  count = addressable ? std::min(count, profile_count(p, axis) - from) : 0;
  for (int i = 0; i < count; ++i) {
    const Run only = runs.only_run(from + i);
    if (only.length() == 0 || only.length() > kLongest) continue;
    const std::ptrdiff_t at = pitch * (from + i) + along * only.first;
    if (at + along * (only.length() - 1) > end) continue;
    const auto lane = static_cast<std::size_t>(i);
    run[lane] = only;
    begin[lane] = static_cast<std::int32_t>(at);
    length[lane] = only.length();
    longest = std::max(longest, length[lane]);
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
