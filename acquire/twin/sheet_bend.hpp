// What it costs to take the bent sheet behind the prism for a plane.
#pragma once

#include <vector>

#include "acquire/twin/twin_options.hpp"

namespace linescope::twin {

/// Depth found with the best plane minus true depth, along the line on a wall at right angles to the optical
/// axis.
struct PlaneError {
  double gap_mm = 0;
  double mean_mm = 0;   ///< weighted with the line's light
  double sd_mm = 0;     ///< the same, around the mean
  double worst_mm = 0;  ///< largest amount within the fan's half angle
};

/// The plane is the one of ideal_calibration(). Fails when the prism of the options gives no sheet. A flat
/// sheet (options.optics.prism.refracted_sheet false) is taken as refracted all the same: that is the
/// question.
Result<std::vector<PlaneError>> plane_errors(TwinOptions options, const std::vector<double>& gaps_mm);

}  // namespace linescope::twin
