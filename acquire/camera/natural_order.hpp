// File names as people count them: im2 before im10.
#pragma once

#include <string_view>

namespace linescope {

/// Runs of digits are compared as numbers of any length, everything else byte by byte. Names that differ only
/// in leading zeros fall back to plain order, so this is a strict total order.
bool natural_less(std::string_view a, std::string_view b);

}  // namespace linescope
