// The metal test: two sensors fixed to each other are carried about. Where the tracker's field is
// undisturbed, their distance and their turn against each other are everywhere the same; metal bends the
// field, and differently at different places.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/pose_sample.hpp"
#include "common/result.hpp"

namespace linescope::calibrate {

struct PairOptions {
  double spacing_mm = 40;  ///< so far from all others a new place begins; every sample counts to the nearest
  int least_places = 5;    ///< 2 .. 1000
  int least_samples = 20;  ///< at a place, otherwise it does not count; 2 .. 100000
  double most_mm = 1.5;    ///< RMS over the places; 0.01 .. 100
  double most_deg = 0.5;   ///< RMS over the places; 0.01 .. 90
};
Result<void> validate(const PairOptions& options);

struct PairPlace {
  Eigen::Vector3d at{0, 0, 0};  ///< mm, of the first sensor in the tracker's frame
  double off_mm = 0;            ///< second sensor seen from the first, against the mean over all places
  double off_deg = 0;           ///< its turn, the same
  std::size_t samples = 0;
};

struct PairCheck {
  std::vector<PairPlace> places;
  double distance_mm = 0;           ///< of the two sensors, mean over the places
  double rms_mm = 0, worst_mm = 0;  ///< over the places
  double rms_deg = 0, worst_deg = 0;
  double extent_mm = 0;               ///< between the two places farthest apart
  std::size_t offered = 0, used = 0;  ///< samples of the first sensor; those at a place that counts
};

/// `first`, `second`: in time order; the second is interpolated at the first's instants. Refuses
/// (verdict.hpp): too few samples with both sensors good; too little variation (fewer places than asked).
Result<PairCheck> check_pair(const std::vector<PoseSample>& first, const std::vector<PoseSample>& second,
                             const PairOptions& options = {});

/// The limits that are exceeded, in one sentence.
Result<void> above_limit(const PairCheck& check, const PairOptions& options);

}  // namespace linescope::calibrate
