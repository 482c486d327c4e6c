// Nanoseconds as seconds with all nine decimals, without going through a double.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>

#include "common/time.hpp"

namespace linescope {

inline std::string seconds_text(Nanoseconds time) {
  const std::uint64_t magnitude =
      time < 0 ? 0 - static_cast<std::uint64_t>(time) : static_cast<std::uint64_t>(time);
  return fmt::format("{}{}.{:09}", time < 0 ? "-" : "", magnitude / kSecond, magnitude % kSecond);
}

}  // namespace linescope
