#include "acquire/laser/noise_meter.hpp"

#include <algorithm>
#include <cmath>

namespace linescope {

void NoiseMeter::clear() {
  counts_.fill(0);
  total_ = 0;
}

void NoiseMeter::add(const Profile& profile, int first, int last) {
  first = std::max(first, 0);
  last = std::min(last, profile.length - 1);
  for (int i = first; i + 2 <= last; ++i)
    ++counts_[static_cast<std::size_t>(std::abs(profile.light(i + 2) - profile.light(i)))];
  total_ += static_cast<std::uint32_t>(std::max(0, last - first - 1));
}

void NoiseMeter::add_sparsely(const PictureView& picture, int lead) {
  constexpr int kRows = 12, kStretch = 64, kLinePixels = 20;
  const int room = std::max(1, picture.width - kStretch);
  const auto row_of = [&](int i) {
    return profile_of(picture, ProfileAxis::row, lead, (2 * i + 1) * picture.height / (2 * kRows));
  };
  const auto first_of = [&](int i) { return i * 7919 % room; };  // scattered, the same for every picture
  // Memory is asked for all of them before the first is needed.
  for (int i = 0; i < kRows; ++i) {
    const Profile row = row_of(i);
    for (int x = 0; x < kStretch && first_of(i) + x < row.length; x += kLinePixels)
      __builtin_prefetch(row.at[0] + (first_of(i) + x) * row.step);
  }
  for (int i = 0; i < kRows; ++i) add(row_of(i), first_of(i), first_of(i) + kStretch - 1);
}

float NoiseMeter::sigma() const {
  constexpr float kFloor = 0.3F;
  if (total_ == 0) return kFloor;
  const double half = 0.5 * total_;
  double below = 0;
  for (std::size_t d = 0; d < counts_.size(); ++d) {
    const double here = counts_[d];
    if (below + here < half) {
      below += here;
      continue;
    }
    // A difference d stands for [d - 1/2, d + 1/2), but 0 only for [0, 1/2).
    const double start = d == 0 ? 0 : static_cast<double>(d) - 0.5, width = d == 0 ? 0.5 : 1.0;
    const double median = start + width * (half - below) / here;
    return std::max(kFloor, static_cast<float>(median / (0.67449 * std::sqrt(2.0))));
  }
  return kFloor;
}

}  // namespace linescope
