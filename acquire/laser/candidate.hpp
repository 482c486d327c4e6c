// Something in one profile that may be the line.
#pragma once

#include <vector>

#include "acquire/laser/extracted_line.hpp"
#include "acquire/laser/light_window.hpp"

namespace linescope {

struct Candidate {
  int profile = 0;
  float centre = 0;      ///< px along the profile
  float sigma = 0;       ///< px, of the Gaussian of the same width at half height
  float peak = 0;        ///< grey levels above the background, laser's channel
  float saturated = 0;   ///< px
  bool clipped = false;  ///< the laser's channel is flat on top
  LightMix mix{};        ///< the light it was found in
  LightMix calm_mix{};   ///< LightWindow::calm_mix
  float structure = 0;   ///< LightWindow::structure
  bool good = true;
  NoPoint fault = NoPoint::no_light;  ///< why not, unless good

  // Filled by the continuity stage.
  int piece = -1;     ///< index of the connected piece
  float support = 0;  ///< evidence that this is the line

  void reject(NoPoint reason) {
    good = false;
    fault = reason;
  }
};

/// Candidates of all profiles, profile by profile: those of profile p are [first[p], first[p + 1]).
struct CandidateList {
  std::vector<Candidate> all;
  std::vector<int> first;

  void begin(int profiles) {
    all.clear();
    first.clear();
    first.reserve(static_cast<std::size_t>(profiles) + 1);
  }
  Candidate* begin_of(int profile) { return all.data() + first[static_cast<std::size_t>(profile)]; }
  Candidate* end_of(int profile) { return all.data() + first[static_cast<std::size_t>(profile) + 1]; }
};

}  // namespace linescope
