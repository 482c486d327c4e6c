// The climb, to be compiled once for each instruction set. Internal to acquire/laser. No function here is
// ever called: all are part of the version that includes them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>

#include "acquire/laser/gauss_climb.hpp"

namespace linescope::gauss_detail {

#define LINESCOPE_PART __attribute__((always_inline)) inline

LINESCOPE_PART bool any(const GaussMask& m) {
  std::array<std::uint64_t, 4> words;
  std::memcpy(words.data(), &m, sizeof(m));
  return (words[0] | words[1] | words[2] | words[3]) != 0;
}

/// Of numbers within +-6, to a millionth.
LINESCOPE_PART void exponential(const GaussLanes& exponent, GaussLanes& e) {
  const GaussLanes x = exponent * (1.0F / 16);
  e = 1 + x * (1.0F / 6);
  for (const float divisor : {1.0F / 5, 1.0F / 4, 1.0F / 3, 1.0F / 2, 1.0F}) e = 1 + x * divisor * e;
  for (int i = 0; i < 4; ++i) e *= e;
}

struct Light {
  GaussLanes weight, moment;  ///< under the Gaussian, and times the distance from the window's middle
  GaussLanes power;           ///< of the Gaussian, as if its weight were 1 at the window's middle
};

/// The level of both flanks; a slope only where the noise does not explain it.
LINESCOPE_PART void take_background_out(const GaussKernel& k, float noise, GaussBatch& b) {
  GaussLanes* const middle = b.window.data() + k.half;
  GaussLanes left{}, right{};
  for (int d = k.flank_begin; d <= k.flank_end; ++d) {
    left += middle[-d];
    right += middle[d];
  }
  const float share = 1.0F / static_cast<float>(k.flank_end - k.flank_begin + 1);
  const GaussLanes rise = (right - left) * share, level = 0.5F * share * (left + right);
  const GaussLanes slope = rise * rise > 18 * noise * noise * share
                               ? rise / static_cast<float>(k.flank_begin + k.flank_end)
                               : GaussLanes{};
  for (int d = -k.half; d <= k.half; ++d) middle[d] -= level + slope * static_cast<float>(d);
}

LINESCOPE_PART void light_below(const GaussKernel& k, const GaussBatch& b, const GaussLanes& place,
                                Light& sum) {
  const GaussLanes* const middle = b.window.data() + k.half;
  // exp(-(d - place)^2 / 2 s^2) is exp(-d^2 / 2 s^2), a table, times exp(place / s^2) to the power of d,
  // times what all weights have in common.
  GaussLanes up;
  exponential(place / (k.sigma * k.sigma), up);
  const GaussLanes down = 1 / up;
  GaussLanes rising = up, falling = down;
  sum.weight = middle[0];
  sum.moment = GaussLanes{};
  sum.power = GaussLanes{} + 1;
  for (int d = 1; d <= k.half; ++d, rising *= up, falling *= down) {
    const float weight = k.weight[static_cast<std::size_t>(d)];
    const GaussLanes above = weight * rising, beneath = weight * falling;
    const GaussLanes a = above * middle[d], c = beneath * middle[-d];
    sum.weight += a + c;
    sum.moment += (a - c) * static_cast<float>(d);
    sum.power += above * above + beneath * beneath;
  }
}

LINESCOPE_PART void climb(const GaussKernel& k, float noise, GaussBatch& b) {
  constexpr int kMostRounds = 6;
  constexpr float kFarthest = 2.0F;  // sigmas from the start beyond which it has wandered off
  const float enough = std::max(1.0F / 16, 0.05F * k.sigma), farthest = kFarthest * k.sigma;
  take_background_out(k, noise, b);
  const GaussLanes most = GaussLanes{} + k.sigma;
  GaussLanes at = b.start;
  GaussMask open = ~GaussMask{};
  b.settled = GaussMask{};
  for (int round = 0; round < kMostRounds && any(open); ++round) {
    Light light;
    light_below(k, b, at, light);
    // Line and kernel are equally wide: the mean sees half of the offset.
    const GaussLanes offset = 2 * (light.moment / light.weight - at);
    const GaussLanes step = offset < -most ? -most : offset > most ? most : offset;
    const GaussLanes moved = at + step, away = moved - b.start;
    // Written so that NaN is lost.
    const GaussMask kept = (light.weight > 0) & (away <= farthest) & (away >= -farthest);
    const GaussMask done = open & ~(kept & ((offset > enough) | (offset < -enough)));
    const GaussMask settles = done & kept;
    if (any(settles)) {
      GaussLanes common;
      exponential(at * at / (-2 * k.sigma * k.sigma), common);
      b.amplitude = settles ? light.weight / (common * light.power) : b.amplitude;
      b.place = settles ? moved : b.place;
      b.settled |= settles;
    }
    at = open ? moved : at;
    open &= ~done;
  }
}

}  // namespace linescope::gauss_detail
