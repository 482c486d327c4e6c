#include "acquire/laser/line_choice.hpp"

#include <algorithm>

namespace linescope {
namespace {

constexpr std::size_t kSmooth = 8;  // chosen neighbours to either side

std::uint32_t& at(NoPointCounts& counts, NoPoint reason) {
  return counts[static_cast<std::size_t>(reason)];
}

}  // namespace

void LineChoice::choose(CandidateList& candidates, const LineExtractorOptions& options, ExtractedLine& line) {
  chosen_.clear();
  const int profiles = line.profiles();
  for (int p = 0; p < profiles; ++p) {
    const Candidate* const c = candidates.begin_of(p);
    if (candidates.end_of(p) - c == 1 && c->good)  // the rule
      chosen_.push_back({c, nullptr, c->sigma});
    else
      choose_in(candidates, p, options, line);
  }
  if (options.centre == CentreMethod::gauss_weighted) smooth_widths();
}

void LineChoice::choose_in(CandidateList& candidates, int profile, const LineExtractorOptions& options,
                           ExtractedLine& line) {
  const Candidate* best = nullptr;
  const Candidate* second = nullptr;
  const Candidate* brightest = nullptr;  // of the rejected
  for (const Candidate* c = candidates.begin_of(profile); c != candidates.end_of(profile); ++c) {
    if (!c->good) {
      ++at(line.rejected_candidates, c->fault);
      if (brightest == nullptr || c->peak > brightest->peak) brightest = c;
    } else if (best == nullptr || c->support > best->support) {
      second = best;
      best = c;
    } else if (second == nullptr || c->support > second->support) {
      second = c;
    }
  }
  if (best == nullptr) {
    ++at(line.no_point, brightest == nullptr ? NoPoint::no_light : brightest->fault);
  } else if (second != nullptr && second->support > static_cast<float>(options.ambiguity) * best->support) {
    ++at(line.no_point, NoPoint::ambiguous);
    at(line.rejected_candidates, NoPoint::ambiguous) += 2;
  } else {
    chosen_.push_back({best, second, best->sigma});
  }
}

/// A line changes its width slowly, and a single profile knows it badly.
void LineChoice::smooth_widths() {
  const std::size_t n = chosen_.size();
  running_.resize(n + 1);
  for (std::size_t begin = 0, end = 0; begin < n; begin = end) {
    const int piece = chosen_[begin].first->piece;
    running_[begin] =
        0;  // sums start anew with each piece, which keeps them exact enough in single precision
    for (end = begin; end < n && chosen_[end].first->piece == piece; ++end)
      running_[end + 1] = running_[end] + chosen_[end].sigma;
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t a = i - std::min(i - begin, kSmooth), b = std::min(end, i + kSmooth + 1);
      chosen_[i].sigma = (running_[b] - running_[a]) / static_cast<float>(b - a);
    }
  }
}

}  // namespace linescope
