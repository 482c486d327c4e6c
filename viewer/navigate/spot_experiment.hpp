// The thesis's navigation experiment as a function: spots with known normals in, errors and coverage out
// (section 5.3).
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "viewer/navigate/normal_estimator.hpp"

namespace linescope {

/// One spot: where the harvester stands by the system, and the truth. Object's frame.
struct Spot {
  NormalQuery query;
  Eigen::Vector3d true_normal{0, 0, 1};  ///< where the true axis meets the true surface; unit, outwards
  Eigen::Vector3d true_axis{0, 0, 1};    ///< of the harvester, from the tip to the handle
};

struct SpotResult {
  NormalReason reason = NormalReason::none;
  double normal_error = 0;      ///< between estimated and true normal, rad; NaN when refused
  double angle_error = 0;       ///< shown angle less true angle, rad; NaN when refused
  bool cone_holds = false;      ///< the true normal lies within the stated 95 % cone
  bool interval_holds = false;  ///< the true angle lies within the stated 95 % interval
  double uncertainty = 0;       ///< the stated cone, rad
};

/// Angles in radians. Errors over the answered spots only; `refused` says what happened to the others.
struct SpotReport {
  std::vector<SpotResult> spots;
  int asked = 0;
  int answered = 0;
  std::array<int, 16> refused{};                                                 ///< by NormalReason
  double mean = 0, deviation = 0, smallest = 0, largest = 0, percentile_95 = 0;  ///< of the normal's error
  double mean_uncertainty = 0;
  double cone_coverage = 0;  ///< share of answered spots
  double interval_coverage = 0;
};

/// Asks every spot of an estimator that already holds the scan.
SpotReport run_spots(const NormalEstimator& estimator, std::span<const Spot> spots, NormalMethod method);

/// The same from the lines of a scan.
SpotReport run_spots(std::span<const NavigationLine> lines, std::span<const Spot> spots,
                     const NormalEstimatorOptions& options);

}  // namespace linescope
