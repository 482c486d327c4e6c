// OpenCV's predefined marker dictionaries by their names without DICT_, any case.
#pragma once

#include <optional>
#include <string_view>

namespace linescope::calibrate {

/// The number OpenCV knows the dictionary by; nothing for an unknown name.
std::optional<int> marker_dictionary(std::string_view name);

}  // namespace linescope::calibrate
