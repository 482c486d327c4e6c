// Colour excess of a pixel whose channels come in the order of Profile (the laser's leading channel first).
#pragma once

#include <algorithm>
#include <array>

#include "acquire/laser/picture_view.hpp"

namespace linescope {

class ColourExcess {
 public:
  explicit ColourExcess(LaserColour colour) {
    const int lead = leading_channel(colour);
    for (int c = 0; c < 3; ++c)
      dark_bits_[static_cast<std::size_t>(c)] =
          (static_cast<unsigned>(colour) >> ((lead + c) % 3) & 1U) != 0 ? 0 : 255;
  }

  /// Smallest of the laser's channels less the largest of the others, may be negative. Without branches: a
  /// dark channel counts as 255 among the lit ones, a lit one as 0 among the dark ones.
  int of(int v0, int v1, int v2) const {
    const auto [d0, d1, d2] = dark_bits_;
    return std::min(v0 | d0, std::min(v1 | d1, v2 | d2)) - std::max(v0 & d0, std::max(v1 & d1, v2 & d2));
  }

  /// 255 for a dark channel, 0 for a lit one: what of() combines values with.
  const std::array<int, 3>& dark_bits() const { return dark_bits_; }

  bool lit(std::size_t channel) const { return dark_bits_[channel] == 0; }
  bool colourless() const { return lit(0) && lit(1) && lit(2); }

 private:
  std::array<int, 3> dark_bits_{};
};

}  // namespace linescope
