// Degrees exist on screens and in files only; inside everything is radians, millimetres, nanoseconds.
#pragma once

#include <numbers>

namespace linescope {

constexpr double radians_from_degrees(double degrees) {
  return degrees * (std::numbers::pi / 180.0);
}
constexpr double degrees_from_radians(double radians) {
  return radians * (180.0 / std::numbers::pi);
}

}  // namespace linescope
