// Counts what a program takes from operator new. Linking linescope_allocation_counter replaces the operator
// in the whole program.
#pragma once

#include <cstddef>

namespace linescope::testing {

/// Allocations of the calling thread so far.
std::size_t allocations_here();

}  // namespace linescope::testing
