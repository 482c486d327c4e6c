// The thesis's way (4.2.3): the mean position of a run, weighted with the colour excess above the threshold.
#pragma once

#include "acquire/laser/candidate.hpp"
#include "acquire/laser/run_block.hpp"

namespace linescope {

/// Fills a new candidate. Peak and width are those of the excess; the width is that of the Gaussian of the
/// same area and height. `length`: of the profile, px.
inline void fill_mean_candidate(const MeanSums& sums, int length, int index, Run run,
                                const LineExtractorOptions& options, Candidate& out) {
  const auto area = static_cast<float>(std::max<std::int64_t>(sums.sum, 1)),
             height = static_cast<float>(sums.peak);
  out.profile = index;
  out.centre = static_cast<float>(run.last + 1) - static_cast<float>(sums.sums) / area;
  out.sigma = area / (height * 2.5066F);
  out.peak = height;
  out.saturated = static_cast<float>(sums.saturated);
  out.judge_shape(kFullWidthPerSigma * out.sigma, run.first, length - 1 - run.last, options);
}

}  // namespace linescope
