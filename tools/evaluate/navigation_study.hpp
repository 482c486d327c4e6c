// The navigation experiment of the thesis (5.3.1) on the twin: a 50 mm cylinder is scanned, then the
// harvester stands on marked spots whose normals are known.
#pragma once

#include <cstdint>

#include "tools/evaluate/form.hpp"
#include "tools/evaluate/virtual_session.hpp"
#include "viewer/navigate/spot_experiment.hpp"

namespace linescope::evaluate {

/// Plain: the thesis's extraction and Algorithm 1; better: better extraction and the robust estimate.
using NavigationOutcome = Columns<SpotReport>;

/// One experiment: its own scan, its own spots. The harvester's tip and axis are what the tracker says while
/// the operator holds still.
Result<NavigationOutcome> navigation_experiment(const Form& form, std::uint64_t seed);

}  // namespace linescope::evaluate
