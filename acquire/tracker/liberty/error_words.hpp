// A LIBERTY's error codes in words.
#pragma once

#include <cstdint>
#include <string_view>

#include "common/status.hpp"

namespace linescope {

/// No error is 0 in binary and a blank in ASCII; both are met in both.
constexpr bool is_error(std::uint8_t code) {
  return code != 0 && code != ' ';
}

/// Known as an error indicator, or no error at all.
bool known_error(std::uint8_t code);

/// Command errors 0x01 .. 0x23, and the letters that come with poses. Empty for no error.
std::string_view error_words(std::uint8_t code);

/// What a pose with that error indicator is worth. 'I' (start-up self-test errors not cleared) says nothing
/// about it.
ToolState state_for_error(std::uint8_t code);

}  // namespace linescope
