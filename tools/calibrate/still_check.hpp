// The tracker at rest: how much a sensor that stands still seems to move, and whether metal disturbs it.
#pragma once

#include <string>
#include <vector>

#include "common/pose_sample.hpp"
#include "common/result.hpp"

namespace linescope::calibrate {

struct StillOptions {
  double least_seconds = 2;       ///< a sensor has to stand still for so long; 0.5 .. 600
  double most_jitter_mm = 0.3;    ///< RMS about the mean place; 0.001 .. 10
  double most_jitter_deg = 0.15;  ///< RMS about the mean attitude; 0.001 .. 10
  double most_drift_mm = 0.2;     ///< between the mean places of both halves; 0.001 .. 10
  double most_distortion = 20;    ///< of the tracker's own metal indicator, mean; 0 .. 1e6
};
Result<void> validate(const StillOptions& options);

struct RestSample {
  double seconds = 0;               ///< since the stretch began
  Eigen::Vector3d off_mm{0, 0, 0};  ///< from the mean place
};

struct StillStation {
  int station = 0;  ///< 0-based
  double seconds = 0;
  std::size_t samples = 0;
  double jitter_mm = 0, jitter_deg = 0, drift_mm = 0;
  double distortion = 0;           ///< NaN: the tracker gives none
  std::vector<RestSample> course;  ///< of the whole stretch
};

/// The longest stretch in which the station moved no further than 2 mm and 1 degree from where the stretch
/// began (a hand moves further within a second); seconds 0 when it never stood still.
StillStation still_stretch(const std::vector<PoseSample>& samples, int station);

/// The figures of all stations that stood still for long enough. Refuses `too_few` when there is none.
Result<std::vector<StillStation>> check_still(const std::vector<StillStation>& stations,
                                              const StillOptions& options);

/// All limits that are exceeded, in one sentence; stations count from 1 in it.
Result<void> above_limit(const std::vector<StillStation>& stations, const StillOptions& options);

}  // namespace linescope::calibrate
