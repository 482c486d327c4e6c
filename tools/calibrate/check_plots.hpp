// What the step check shows besides its figures.
#pragma once

#include "tools/calibrate/pair_check.hpp"
#include "tools/calibrate/shape_check.hpp"
#include "tools/calibrate/step.hpp"
#include "tools/calibrate/still_check.hpp"

namespace linescope::calibrate {

/// Distance of the scanned points from the body of known size, as a map of the patch and line by line.
Plot plot_shape(const ShapeCheck& check, const ShapeCheckOptions& options);

/// How each sensor at rest seemed to move.
Plot plot_still(const std::vector<StillStation>& stations, const StillOptions& options);

/// How much two sensors fixed to each other differ from place to place.
Plot plot_pair(const PairCheck& check, const PairOptions& options);

}  // namespace linescope::calibrate
