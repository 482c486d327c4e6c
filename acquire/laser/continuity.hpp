// Lines are connected curves: links candidates of neighbouring profiles into pieces and lets the best piece
// win.
#pragma once

#include "acquire/laser/candidate.hpp"

namespace linescope {

/// Links good candidates to pieces, fills `piece` and `support`, and rejects those of pieces that are too
/// short (isolated). Support is the brightness, of the candidate and of its whole piece, and grows with the
/// piece's length up to a few times min_run: beyond that a longer piece is no better, so that a long faint
/// reflection does not beat the line broken by texture.
class Continuity {
 public:
  void link(CandidateList& candidates, int profiles, const LineExtractorOptions& options);

  int pieces() const { return static_cast<int>(pieces_.size()); }

 private:
  struct Piece {
    int count = 0;
    double peaks = 0;   ///< their sum; once all are linked, their mean
    double weight = 0;  ///< of a peak in the support
  };
  void extend(CandidateList& candidates, int profile, const LineExtractorOptions& options);
  /// The common case, one candidate after one: how many profiles, from `profile` on, it lasts.
  int extend_singles(CandidateList& candidates, int profile, int profiles,
                     const LineExtractorOptions& options);
  void continue_with(CandidateList& candidates, const Candidate& from, Candidate& to);
  std::vector<Piece> pieces_;
  std::vector<char> continued_;  ///< per candidate: something already goes on from it
};

}  // namespace linescope
