// How far the displayed angle is off when a harvester stands on the marked spots of a scanned condyle.
#pragma once

#include "common/calibration.hpp"
#include "tests/integration/calibrate/twin_recordings.hpp"

namespace linescope::calibrate {

/// Scan, withdrawal, harvester on three spots.
twin::TwinOptions navigating(twin::TwinOptions options);
inline constexpr double kNavigatingSeconds = 25;

struct NavigationError {
  double rms_rad = 0;  ///< of displayed less true angle
  int shown = 0;       ///< instants with an angle
  int asked = 0;
};

/// Lines and harvester placed with `calibration`, the normal by the viewer's own estimator.
NavigationError navigation_error(const Recording& recording, const Calibration& calibration);

}  // namespace linescope::calibrate
