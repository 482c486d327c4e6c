// What the best possible calibration of the simulated instrument would find.
#pragma once

#include "acquire/twin/twin_options.hpp"
#include "common/calibration.hpp"

namespace linescope::twin {

/// `options` valid. Lens and plane are the true ones where the calibration's forms can express them; else
/// their best fit.
Calibration ideal_calibration(const TwinOptions& options);

}  // namespace linescope::twin
