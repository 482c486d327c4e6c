// The thesis's way (4.2.3): the mean position of a run, weighted with the colour excess above the threshold.
#pragma once

#include "acquire/laser/candidate.hpp"
#include "acquire/laser/colour_excess.hpp"
#include "acquire/laser/run_finder.hpp"

namespace linescope {

/// Fills a new candidate. Peak and width are those of the excess; the width is that of the Gaussian of the
/// same area and height.
void fill_mean_candidate(const Profile& profile, int index, Run run, const ColourExcess& excess,
                         const LineExtractorOptions& options, Candidate& out);

}  // namespace linescope
