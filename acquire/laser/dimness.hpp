// Rejects candidates that do not stand out: from the noise, or beside the strong ones of the same picture.
#pragma once

#include "acquire/laser/candidate.hpp"

namespace linescope {

/// `noise`: standard deviation of the picture's background, grey levels. Rejected as too_dim.
void reject_dim(CandidateList& candidates, float noise, const LineExtractorOptions& options);

}  // namespace linescope
