// One candidate per profile: the one with the most support, unless a rival has about as much.
#pragma once

#include <span>
#include <vector>

#include "acquire/laser/candidate.hpp"

namespace linescope {

struct Choice {
  const Candidate* first = nullptr;
  const Candidate* second = nullptr;  ///< the next best, or none
  float sigma = 0;                    ///< width of the line, averaged over neighbours of the same piece
};

class LineChoice {
 public:
  /// Fills no_point and rejected_candidates of `line` for the profiles without a choice. The candidates must
  /// outlive it.
  void choose(CandidateList& candidates, const LineExtractorOptions& options, ExtractedLine& line);

  std::span<const Choice> chosen() const { return chosen_; }

 private:
  void choose_in(CandidateList& candidates, int profile, const LineExtractorOptions& options,
                 ExtractedLine& line);
  void smooth_widths();

  std::vector<Choice> chosen_;
  std::vector<float> running_;  ///< sums of the widths
};

}  // namespace linescope
