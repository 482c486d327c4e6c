// What the plain and the vector version of the first look share. Internal to acquire/laser.
#pragma once

#include "acquire/laser/line_mask.hpp"

namespace linescope::mask_detail {

/// Where the ridge test looks, in bytes from the pixel; both the same where only one side lies in the
/// picture.
struct Sides {
  std::ptrdiff_t before = 0;
  std::ptrdiff_t after = 0;
  bool any() const { return before != 0; }
};

/// Sides for the group of pixels that starts at x (a multiple of kMaskGroup).
Sides sides_of_group(const PictureView& picture, const MaskRule& rule, int y, int x);

/// Markers for BGR pictures, or nothing where the processor cannot run them.
Marker avx2_marker(const MaskRule& rule);
Marker avx512_marker(const MaskRule& rule);

/// Marks of the group that starts at x, at most to the end of the row.
std::uint32_t mark_group(const PictureView& picture, const MaskRule& rule, int y, int x);

}  // namespace linescope::mask_detail
