// First look at every pixel: may it belong to the line? The only stage that reads the whole picture, so it
// decides the speed.
#pragma once

#include <cstdint>

#include "acquire/laser/picture_view.hpp"

namespace linescope {

/// The two tests of LineExtractorOptions as whole numbers.
struct MaskRule {
  unsigned on = 2;            ///< bits of LaserColour
  int lead = 1;               ///< leading_channel
  int colour_threshold = 24;  ///< excess from which a pixel is marked; 256 marks none
  int ridge_threshold = 12;   ///< brightness over both sides from which a pixel is marked; 256 marks none
  int reach = 24;             ///< px to the sides
  ProfileAxis axis = ProfileAxis::column;

  bool ridge() const { return ridge_threshold < 256; }
};
MaskRule mask_rule(const LineExtractorOptions& options, int channels);

/// Pixels are marked in groups of this many: bit i of word w is pixel 32 w + i of the row.
inline constexpr int kMaskGroup = 32;
constexpr int mask_words(int width) {
  return (width + kMaskGroup - 1) / kMaskGroup;
}

/// Marks the picture, row after row in `words`. A side of the ridge test that would leave the picture is not
/// asked (along rows: for the whole group), and with no side left the test marks nothing.
using Marker = void (*)(const PictureView& picture, const MaskRule& rule, std::uint32_t* words);

/// Plain C++, the definition of what is marked.
void mark_picture(const PictureView& picture, const MaskRule& rule, std::uint32_t* words);

/// The same marks by the longest vectors that the processor has; mark_picture for grey pictures and other
/// processors.
Marker fastest_marker(const PictureView& picture, const MaskRule& rule);

}  // namespace linescope
