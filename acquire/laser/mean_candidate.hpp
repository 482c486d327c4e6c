// The thesis's way (4.2.3): the mean position of a run, weighted with the colour excess above the threshold.
#pragma once

#include "acquire/laser/candidate.hpp"
#include "acquire/laser/run_block.hpp"

namespace linescope {

/// Fills a new candidate. `length`: of the profile, px.
inline void fill_mean_candidate(const RunMean& mean, int length, int index, Run run,
                                const ShapeLimits& limits, Candidate& out) {
  out.profile = index;
  out.centre = static_cast<float>(run.last + 1) - mean.before_end;
  out.sigma = mean.sigma;
  out.peak = mean.peak;
  out.saturated = mean.saturated;
  out.judge_shape(kFullWidthPerSigma * out.sigma, run.first, length - 1 - run.last, limits);
}

}  // namespace linescope
