// The harvester on the marked spots: what the viewer would ask, and what really is.
#pragma once

#include <vector>

#include "acquire/twin/virtual_experiment.hpp"
#include "common/calibration.hpp"
#include "viewer/navigate/spot_experiment.hpp"

namespace linescope::study {

/// One instant per spot, somewhere while the harvester stands on it. Tip and axis come from the newest
/// tracker samples of object and harvester and from the calibration, as in the viewer; truth (true normal
/// where the true axis meets the true surface) from the twin. `experiment` must not end before its last spot.
std::vector<Spot> stand_on_spots(const std::shared_ptr<const twin::VirtualExperiment>& experiment,
                                 const Calibration& calibration);

}  // namespace linescope::study
