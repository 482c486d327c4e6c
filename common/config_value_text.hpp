// How values and ranges of the configuration are written. Used by the parts of ConfigSchema only.
#pragma once

#include <string>
#include <vector>

#include "common/config_schema.hpp"

namespace linescope::config {

/// "between 1 and 240", "at least 1", "at most 240", "a number".
std::string range_text(const NumberSpec& spec);

/// "3 items", "1 to 8 items", "at least 1 item".
std::string count_text(const ListSpec& spec);

/// "\"usb\" or \"serial\"".
std::string words_text(const std::vector<std::string>& words);

/// The shortest number d with spec.scale * d == field, where there is one: what a person would have written.
std::string number_text(double field, double scale);

}  // namespace linescope::config
