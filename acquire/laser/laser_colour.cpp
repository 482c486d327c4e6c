#include "acquire/laser/laser_colour.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

namespace linescope {
namespace {

constexpr std::array<std::pair<LaserColour, std::string_view>, 7> kNames{{{LaserColour::red, "red"},
                                                                          {LaserColour::green, "green"},
                                                                          {LaserColour::blue, "blue"},
                                                                          {LaserColour::cyan, "cyan"},
                                                                          {LaserColour::violet, "violet"},
                                                                          {LaserColour::yellow, "yellow"},
                                                                          {LaserColour::mono, "mono"}}};

}  // namespace

std::string_view name(LaserColour colour) {
  for (const auto& [value, word] : kNames)
    if (value == colour) return word;
  return "unknown";
}

Result<LaserColour> laser_colour_from_name(std::string_view text) {
  std::string known;
  for (const auto& [value, word] : kNames) {
    if (word == text) return value;
    known += known.empty() ? "" : ", ";
    known += word;
  }
  return fail(ErrorCode::invalid, fmt::format("laser colour '{}' is unknown; known are {}", text, known));
}

}  // namespace linescope
