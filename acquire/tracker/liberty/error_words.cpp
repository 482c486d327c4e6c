#include "acquire/tracker/liberty/error_words.hpp"

#include <array>

namespace linescope {
namespace {

constexpr std::array<std::string_view, 0x24> kCommandErrors = {
    "",
    "invalid command",
    "station out of range",
    "invalid parameter",
    "too few parameters",
    "too many parameters",
    "parameter below its limit",
    "parameter above its limit",
    "communication with the sensor processor failed",
    "sensor processor 1 did not start",
    "sensor processor 2 did not start",
    "sensor processor 3 did not start",
    "sensor processor 4 did not start",
    "no sensor processor detected",
    "source processor did not start",
    "memory error",
    "too many characters in a command",
    "mode must be left first",
    "source memory (PROM) error",
    "setting can only be read",
    "text message",
    "map could not be loaded",
    "sensors could not be synchronised",
    "firmware upgrade required",
    "firmware upgrade recommended",
    "source current could not be set",
    "internal error 1a",
    "internal error 1b",
    "internal error 1c",
    "internal error 1d",
    "* is not possible with this command",
    "internal error 1f",
    "",
    "marker error 21",
    "marker error 22",
    "marker error 23",
};

constexpr std::array<std::string_view, 7> kCoilFailures = {
    "source coil X failed",          "source coil Y failed",        "source coils X and Y failed",
    "source coil Z failed",          "source coils X and Z failed", "source coils Y and Z failed",
    "source coils X, Y and Z failed"};

constexpr std::array<std::string_view, 7> kCoilFailuresWithSelfTest = {
    "source coil X failed, and self-test errors are not cleared",
    "source coil Y failed, and self-test errors are not cleared",
    "source coils X and Y failed, and self-test errors are not cleared",
    "source coil Z failed, and self-test errors are not cleared",
    "source coils X and Z failed, and self-test errors are not cleared",
    "source coils Y and Z failed, and self-test errors are not cleared",
    "source coils X, Y and Z failed, and self-test errors are not cleared"};

}  // namespace

bool known_error(std::uint8_t code) {
  return !is_error(code) || !error_words(code).empty();
}

std::string_view error_words(std::uint8_t code) {
  if (!is_error(code)) return {};
  if (code < kCommandErrors.size()) return kCommandErrors[code];
  if (code >= 'a' && code <= 'g') return kCoilFailures[code - std::size_t{'a'}];
  if (code >= 'A' && code <= 'G') return kCoilFailuresWithSelfTest[code - std::size_t{'A'}];
  if (code == 'I') return "self-test errors are not cleared";
  if (code == 'u') return "outside the mapped area";
  return {};
}

ToolState state_for_error(std::uint8_t code) {
  if (!is_error(code) || code == 'I') return ToolState::ok;
  return code == 'u' ? ToolState::out_of_view : ToolState::missing;
}

}  // namespace linescope
