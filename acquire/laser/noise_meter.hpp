// Noise of the picture beside the line, from differences between pixels two apart (next neighbours share
// colour samples).
#pragma once

#include <array>
#include <cstdint>

#include "acquire/laser/picture_view.hpp"

namespace linescope {

class NoiseMeter {
 public:
  void clear();

  /// Pixels [first, last] of the profile are background; what lies outside the profile is left out.
  void add(const Profile& profile, int first, int last);

  /// Samples a few stretches of rows all over the picture: a first idea before anything is known of the line.
  void add_sparsely(const PictureView& picture, int lead);

  /// Standard deviation in grey levels by the median of the differences, which edges and texture hardly move;
  /// at least 0.3, the rounding to whole grey levels, also when nothing was added.
  float sigma() const;

 private:
  std::array<std::uint32_t, 256> counts_{};  ///< of the absolute differences
  std::uint32_t total_ = 0;
};

}  // namespace linescope
