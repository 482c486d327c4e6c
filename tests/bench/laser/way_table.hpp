// The rows of a comparison as people read them.
#pragma once

#include <string>
#include <vector>

#include "tests/bench/paired.hpp"

namespace linescope::bench {

/// Prints name, median, fastest, and both as multiples of the first row.
void print_table(const std::string& title, const std::vector<Way>& rows);

}  // namespace linescope::bench
