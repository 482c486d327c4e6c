// Counts what a program takes from operator new. Linking linescope_allocation_counter replaces the operator
// in the whole program.
#pragma once

#include <cstddef>

namespace linescope::testing {

/// Allocations so far: of the calling thread, and of all.
std::size_t allocations_here();
std::size_t allocations_everywhere();

}  // namespace linescope::testing
