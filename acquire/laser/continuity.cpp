#include "acquire/laser/continuity.hpp"

#include <algorithm>
#include <cmath>

namespace linescope {
namespace {

float allowed_step(const Candidate& a, const Candidate& b, const LineExtractorOptions& options) {
  return std::max(static_cast<float>(options.max_step), 0.5F * std::max(a.sigma, b.sigma));
}

/// How badly b continues a, 0 best, 1 at the limit; broad lines are allowed broader steps.
float misfit(const Candidate& a, const Candidate& b, const LineExtractorOptions& options) {
  const auto steps = static_cast<float>(b.profile - a.profile);
  return std::abs(b.centre - a.centre) / (allowed_step(a, b, options) * steps) + 0.1F * (steps - 1);
}

}  // namespace

int Continuity::extend_singles(CandidateList& list, int profile, int profiles,
                               const LineExtractorOptions& options) {
  const auto single = [&list](int p) {
    Candidate* const c = list.begin_of(p);
    return list.end_of(p) - c == 1 && c->good ? c : nullptr;
  };
  if (profile == 0) return 0;
  const Candidate* before = single(profile - 1);
  if (before == nullptr) return 0;
  const int from = profile;
  Piece& whole = pieces_[static_cast<std::size_t>(before->piece)];
  Piece piece = whole;
  for (; profile < profiles; ++profile) {
    Candidate* const c = single(profile);
    if (c == nullptr || std::abs(c->centre - before->centre) >= allowed_step(*before, *c, options)) break;
    c->piece = before->piece;
    continued_[static_cast<std::size_t>(before - list.all.data())] = 1;
    ++piece.count;
    piece.peaks += c->peak;
    before = c;
  }
  whole = piece;
  return profile - from;
}

void Continuity::continue_with(CandidateList& list, const Candidate& from, Candidate& to) {
  to.piece = from.piece;
  continued_[static_cast<std::size_t>(&from - list.all.data())] = 1;
  Piece& piece = pieces_[static_cast<std::size_t>(to.piece)];
  ++piece.count;
  piece.peaks += to.peak;
}

/// Connects the candidates of one profile to those before it, best fit first; nothing is continued twice.
void Continuity::extend(CandidateList& list, int profile, const LineExtractorOptions& options) {
  Candidate* const begin = list.begin_of(profile);
  Candidate* const end = list.end_of(profile);
  for (;;) {
    Candidate* best = nullptr;
    const Candidate* from = nullptr;
    float least = 1.0F;
    for (Candidate* c = begin; c != end; ++c) {
      if (!c->good || c->piece >= 0) continue;
      for (int p = profile - 1; p >= std::max(0, profile - 1 - options.max_gap); --p) {
        for (const Candidate* a = list.begin_of(p); a != list.end_of(p); ++a) {
          if (!a->good || continued_[static_cast<std::size_t>(a - list.all.data())] != 0) continue;
          const float m = misfit(*a, *c, options);
          if (m < least) least = m, best = c, from = a;
        }
        if (from != nullptr) break;
      }
    }
    if (best == nullptr) break;
    continue_with(list, *from, *best);
  }
  for (Candidate* c = begin; c != end; ++c) {
    if (!c->good || c->piece >= 0) continue;
    c->piece = pieces();
    pieces_.push_back({1, c->peak, 0});
  }
}

void Continuity::link(CandidateList& list, int profiles, const LineExtractorOptions& options) {
  pieces_.clear();
  continued_.assign(list.all.size(), 0);
  for (int p = 0; p < profiles;) {
    const int done = extend_singles(list, p, profiles, options);
    if (done == 0) extend(list, p, options);
    p += std::max(done, 1);
  }
  for (Piece& piece : pieces_) {
    piece.weight = 0.5 * std::min(1.0, piece.count / (3.0 * options.min_run));
    piece.peaks /= piece.count;
  }
  for (Candidate& c : list.all) {
    if (!c.good) continue;
    const Piece& piece = pieces_[static_cast<std::size_t>(c.piece)];
    c.support = static_cast<float>(piece.weight * (c.peak + piece.peaks));
    if (piece.count < options.min_run) c.reject(NoPoint::isolated);
  }
}

}  // namespace linescope
