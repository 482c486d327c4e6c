// The laser's colour as a camera with blue, green and red pixels sees it.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

#include "common/result.hpp"

namespace linescope {

/// The set of channels in which the laser shines, as bits. A pixel's colour excess is
///   min(channels in the set) - max(channels outside), not below 0
/// in grey levels; for mono (all three) it is the darkest channel itself. The values are those of a bit set,
/// so that any laser that lights one or two channels can be named; Nd:YAG green (532 nm) and diode green are
/// `green`.
enum class LaserColour : std::uint8_t {
  blue = 1,
  green = 2,
  cyan = 3,  ///< blue and green, 488 nm
  red = 4,
  violet = 5,  ///< blue and red, 405 nm
  yellow = 6,  ///< green and red, 589 nm
  mono = 7,    ///< no colour to go by: monochrome cameras, and the only light in a dark scene
};

/// As configuration files name them.
inline constexpr std::array<std::pair<const char*, LaserColour>, 7> kLaserColourWords{
    {{"red", LaserColour::red},
     {"green", LaserColour::green},
     {"blue", LaserColour::blue},
     {"cyan", LaserColour::cyan},
     {"violet", LaserColour::violet},
     {"yellow", LaserColour::yellow},
     {"mono", LaserColour::mono}}};

/// The word of configuration files.
std::string_view name(LaserColour colour);

/// The colour of that name, or a sentence that lists the known ones.
Result<LaserColour> laser_colour_from_name(std::string_view name);

}  // namespace linescope
