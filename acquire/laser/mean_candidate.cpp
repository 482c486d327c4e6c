#include "acquire/laser/mean_candidate.hpp"

#include <algorithm>
#include <cstdint>

namespace linescope {

Candidate mean_candidate(const Profile& profile, int index, Run run, const ColourExcess& excess,
                         const LineExtractorOptions& options) {
  int sum = 0, peak = 1, saturated = 0;
  std::int64_t moment = 0;
  const std::uint8_t* p = profile.at[0] + run.first * profile.step;
  const std::ptrdiff_t second = profile.at[1] - profile.at[0], third = profile.at[2] - profile.at[0];
  for (int i = 0; i < run.length(); ++i, p += profile.step) {
    const int e = excess.of(p[0], p[second], p[third]);
    const int weight = e >= options.colour_threshold ? e : 0;
    saturated += p[0] >= options.saturation_level ? 1 : 0;
    sum += weight;
    moment += weight * i;
    peak = std::max(peak, weight);
  }
  const auto area = static_cast<float>(std::max(sum, 1)), height = static_cast<float>(peak);
  Candidate c;
  c.profile = index;
  c.centre = static_cast<float>(run.first) + static_cast<float>(moment) / area;
  c.sigma = area / (height * 2.5066F);
  c.peak = height;
  c.saturated = static_cast<float>(saturated);
  c.judge_shape(kFullWidthPerSigma * c.sigma, run.first, profile.length - 1 - run.last, options);
  return c;
}

}  // namespace linescope
