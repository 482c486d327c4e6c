#include "acquire/laser/mean_candidate.hpp"

#include <algorithm>
#include <cstdint>

namespace linescope {

void fill_mean_candidate(const Profile& profile, int index, Run run, const ColourExcess& excess,
                         const LineExtractorOptions& options, Candidate& out) {
  int sum = 0, peak = 1, saturated = 0;
  std::int64_t sums = 0;  // of the sums so far: each weight as often as there are pixels from it to the end
  const std::uint8_t* p = profile.at[0] + run.first * profile.step;
  const std::ptrdiff_t second = profile.at[1] - profile.at[0], third = profile.at[2] - profile.at[0];
  for (int i = run.length(); i > 0; --i, p += profile.step) {
    const int e = excess.of(p[0], p[second], p[third]);
    const int weight = e >= options.colour_threshold ? e : 0;
    saturated += p[0] >= options.saturation_level ? 1 : 0;
    sum += weight;
    sums += sum;
    peak = std::max(peak, weight);
  }
  const auto area = static_cast<float>(std::max(sum, 1)), height = static_cast<float>(peak);
  out.profile = index;
  out.centre = static_cast<float>(run.last + 1) - static_cast<float>(sums) / area;
  out.sigma = area / (height * 2.5066F);
  out.peak = height;
  out.saturated = static_cast<float>(saturated);
  out.judge_shape(kFullWidthPerSigma * out.sigma, run.first, profile.length - 1 - run.last, options);
}

}  // namespace linescope
