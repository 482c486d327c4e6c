#include "acquire/laser/laser_colour.hpp"

#include <fmt/format.h>

namespace linescope {

std::string_view name(LaserColour colour) {
  for (const auto& [word, value] : kLaserColourWords)
    if (value == colour) return word;
  return "unknown";
}

Result<LaserColour> laser_colour_from_name(std::string_view text) {
  std::string known;
  for (const auto& [word, value] : kLaserColourWords) {
    if (word == text) return value;
    known += known.empty() ? "" : ", ";
    known += word;
  }
  return fail(ErrorCode::invalid, fmt::format("laser colour '{}' is unknown; known are {}", text, known));
}

}  // namespace linescope
