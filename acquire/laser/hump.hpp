// A bump in the light of a profile: where it is and how wide at half height.
#pragma once

#include "acquire/laser/light_window.hpp"

namespace linescope {

/// Indices are those of the window.
struct Hump {
  int first = 0, last = 0;  ///< pixels above half height, dips of up to merge_gap included
  int peak = 0;             ///< index of the highest place
  int level = 0;            ///< light at half height
  int height = 0;           ///< light of the top above the background
  float centre = 0;         ///< mean position of the light above half height
  float width = 0;          ///< full width at half height, px
};

/// Index of the middle of the brightest stretch of `box` pixels within [from, to). Precondition: from < to.
int brightest(const LightWindow& window, int from, int to, int box);

/// The bump around `peak`.
Hump hump_around(const LightWindow& window, int peak, int merge_gap);

}  // namespace linescope
