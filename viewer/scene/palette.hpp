// Colours of the scene and of the panel: one set that people with any kind of colour vision can tell apart
// (after Okabe and Ito), on a dark ground for a dark room. Red, green, blue, 0..1.
#pragma once

#include <array>

namespace linescope {

using Rgb = std::array<double, 3>;

namespace palette {

constexpr Rgb of(int hex) {
  return {((hex >> 16) & 255) / 255.0, ((hex >> 8) & 255) / 255.0, (hex & 255) / 255.0};
}

inline constexpr Rgb kGround = of(0x0e1216);
inline constexpr Rgb kGroundTop = of(0x1a2128);
inline constexpr Rgb kText = of(0xd7dde3);
inline constexpr Rgb kQuiet = of(0x7d8893);
inline constexpr Rgb kCloud = of(0x8fb8c9);
inline constexpr Rgb kNewLine = of(0xf0e442);
inline constexpr Rgb kSurface = of(0xd9cdb8);
inline constexpr Rgb kInside = of(0x6e6353);  ///< the back of the surface
inline constexpr Rgb kFilled = of(0x6a7f96);  ///< closed holes nobody measured
inline constexpr Rgb kGrid = of(0xcc79a7);
inline constexpr Rgb kHarvester = of(0x56b4e9);
inline constexpr Rgb kTip = of(0xffffff);
inline constexpr Rgb kNormal = of(0xe69f00);
inline constexpr Rgb kEndoscope = of(0x7d8893);
inline constexpr Rgb kOnTarget = of(0x2fc79b);
inline constexpr Rgb kMeasure = of(0xf0e442);

}  // namespace palette
}  // namespace linescope
