// How far measured points are from the phantom they were measured on.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "acquire/twin/twin_truth.hpp"
#include "viewer/view_state.hpp"

namespace linescope::evaluate {

/// Signed distances, mm: positive outside.
struct Deviations {
  double mean = 0;       ///< bias
  double deviation = 0;  ///< standard deviation about the mean: precision
  double rms = 0;        ///< about the truth
  std::size_t count = 0;
};

Deviations deviations_of(const std::vector<double>& distances);

/// Points of the lines with from <= time < to.
Deviations deviations_of(const HeldLines& lines, const twin::TwinTruth& truth, Nanoseconds from,
                         Nanoseconds to);
Deviations deviations_of(const HeldLines& lines, const twin::TwinTruth& truth);

/// Vertices, or any places in the object's frame.
Deviations deviations_of(const std::vector<Eigen::Vector3f>& places, const twin::TwinTruth& truth);

}  // namespace linescope::evaluate
