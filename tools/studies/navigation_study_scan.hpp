// One seeded scan of the twin through daemon and viewer code, in one process.
#pragma once

#include "acquire/twin/twin_options.hpp"
#include "common/calibration.hpp"
#include "common/result.hpp"
#include "viewer/view_state.hpp"

namespace linescope::study {

struct StudyScan {
  Calibration calibration;  ///< as the twin's instrument was calibrated
  HeldLines lines;          ///< in the object's frame, as the viewer holds them
};

/// Renders, extracts, triangulates, publishes into a segment of its own, reads it back and places every line
/// with the poses of its instant. Lasts as long as `options.duration` in the experiment's time, computed as
/// fast as possible. `mean_over` as in PoseHistoryOptions.
Result<StudyScan> scan_twin(const twin::TwinOptions& options, Nanoseconds mean_over);

}  // namespace linescope::study
