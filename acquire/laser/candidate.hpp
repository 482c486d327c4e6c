// Something in one profile that may be the line.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "acquire/laser/extracted_line.hpp"
#include "acquire/laser/light_window.hpp"

namespace linescope {

/// Full width at half height of a Gaussian of sigma 1.
inline constexpr float kFullWidthPerSigma = 2.3548F;

/// What a candidate's shape must keep to, as the numbers it is compared with.
struct ShapeLimits {
  float max_saturated = 0, max_width = 0, min_width = 0;
  int border = 0;

  explicit ShapeLimits(const LineExtractorOptions& o)
      : max_saturated(static_cast<float>(o.max_saturated)),
        max_width(static_cast<float>(o.max_width)),
        min_width(static_cast<float>(o.min_width)),
        border(o.border) {}
};

struct Candidate {
  int profile = 0;
  float centre = 0;      ///< px along the profile
  float sigma = 0;       ///< px, of the Gaussian of the same width at half height
  float peak = 0;        ///< grey levels above the background, laser's channel
  float saturated = 0;   ///< px
  int look = -1;         ///< CandidateList::looks; -1 for a weighted mean
  bool clipped = false;  ///< the laser's channel is flat on top
  bool good = true;
  NoPoint fault = NoPoint::no_light;  ///< why not, unless good

  // Filled by the continuity stage.
  int piece = -1;     ///< index of the connected piece
  float support = 0;  ///< evidence that this is the line

  void reject(NoPoint reason) {
    good = false;
    fault = reason;
  }

  /// Rejects what is no line by its shape. `width`: full, px; `before`, `after`: px to the ends of the
  /// profile.
  void judge_shape(float width, int before, int after, const ShapeLimits& limits) {
    if (std::min(before, after) < limits.border)
      reject(NoPoint::at_border);
    else if (saturated > limits.max_saturated)
      reject(NoPoint::saturated);
    else if (width > limits.max_width)
      reject(NoPoint::too_wide);
    else if (width < limits.min_width)
      reject(NoPoint::too_narrow);
  }
};

/// The light in which candidates were found; shared by those that follow one that was looked at.
struct Look {
  LightMix mix{};
  LightMix calm_mix{};  ///< LightWindow::calm_mix
  float structure = 0;  ///< LightWindow::structure
};

/// Candidates of all profiles, profile by profile: those of profile p are [first[p], first[p + 1]).
struct CandidateList {
  std::vector<Candidate> all;
  std::vector<int> first;
  std::vector<Look> looks;

  void begin(int profiles) {
    all.clear();
    looks.clear();
    first.clear();
    first.reserve(static_cast<std::size_t>(profiles) + 1);
  }
  Candidate* begin_of(int profile) { return all.data() + first[static_cast<std::size_t>(profile)]; }
  Candidate* end_of(int profile) { return all.data() + first[static_cast<std::size_t>(profile) + 1]; }
};

}  // namespace linescope
