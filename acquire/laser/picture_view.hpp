// A picture as plain bytes, and one profile (column or row) of it. No ownership.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "acquire/laser/line_extractor_options.hpp"

namespace linescope {

struct PictureView {
  const std::uint8_t* data = nullptr;
  std::ptrdiff_t stride = 0;  ///< bytes from one row to the next
  int width = 0;              ///< px
  int height = 0;             ///< px
  int channels = 3;           ///< 3 (blue, green, red) or 1 (grey)
};

/// The pixels of one profile, first to last: `at[channel]` of pixel i lies at `at[channel][i * step]`.
/// Channel 0 is the laser's leading channel, 1 and 2 are the other two (for grey pictures all three are the
/// same bytes).
struct Profile {
  std::array<const std::uint8_t*, 3> at{};
  std::ptrdiff_t step = 0;
  int length = 0;

  int value(int channel, int i) const { return at[static_cast<std::size_t>(channel)][i * step]; }
  int light(int i) const { return value(0, i); }
};

/// The channel that carries the line of a laser of this colour: 0 blue, 1 green, 2 red.
constexpr int leading_channel(LaserColour colour) {
  switch (colour) {
    case LaserColour::blue:
    case LaserColour::violet:
      return 0;
    case LaserColour::red:
      return 2;
    default:
      return 1;
  }
}

constexpr int profile_count(const PictureView& p, ProfileAxis axis) {
  return axis == ProfileAxis::column ? p.width : p.height;
}

inline Profile profile_of(const PictureView& picture, ProfileAxis axis, int lead, int index) {
  const bool column = axis == ProfileAxis::column;
  const std::uint8_t* first = picture.data + (column ? picture.channels : picture.stride) * index;
  Profile p;
  p.step = column ? picture.stride : picture.channels;
  p.length = column ? picture.height : picture.width;
  const bool grey = picture.channels == 1;
  for (int i = 0; i < 3; ++i) p.at[static_cast<std::size_t>(i)] = first + (grey ? 0 : (lead + i) % 3);
  return p;
}

}  // namespace linescope
