// The navigation experiment of the thesis (5.3.1) on the twin: a 50 mm cylinder is scanned, then the
// harvester stands on marked spots whose normals are known.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/evaluate/form.hpp"
#include "viewer/navigate/spot_experiment.hpp"

namespace linescope::evaluate {

struct NavigationOutcome {
  SpotReport plain;   ///< thesis's extraction and Algorithm 1
  SpotReport better;  ///< better extraction and the robust estimate
};

/// One experiment: its own scan, its own spots. The harvester's tip and axis are what the tracker says while
/// the operator holds still.
Result<NavigationOutcome> navigation_experiment(const Form& form, std::uint64_t seed);

}  // namespace linescope::evaluate
