// Results for people.
#pragma once

#include <string>

#include "tools/calibrate/record_entry.hpp"
#include "tools/calibrate/verdict.hpp"

namespace linescope::calibrate {

/// Residual and held-out error under their own names, counts, parameters with deviations, spread, everything
/// that was left out.
std::string as_text(const Quality& quality);

/// What `linescope-calibrate show` prints: each value of the calibration in plain words, with the entry it
/// comes from, or that it was never calibrated; then the history.
std::string as_text(const Calibration& calibration, const std::vector<Entry>& entries);

}  // namespace linescope::calibrate
