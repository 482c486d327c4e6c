// The surface of a patch with lines as groups whose errors are shared, and what it does not know about its
// slope.
//
// Model (local frame): z = cubic(x, y) + offset_l + tilt_l (s - s_l) + noise. Every line l has one offset and
// one tilt (its pose's error), offsets have a part that is new with every line and a part that drifts from
// line to line (an Ornstein-Uhlenbeck process in time). Generalised least squares; the sizes of the noises
// come from the residuals, the share of drift is not chosen but averaged over by its likelihood. Cubic terms
// have a prior that follows the curvature.
#pragma once

#include <Eigen/Core>

#include "viewer/navigate/patch.hpp"
#include "viewer/navigate/robust_quadric.hpp"

namespace linescope {

struct SolutionOptions {
  double segment_floor = 0.005;  ///< error of a segment whatever its points say, mm
  double line_prior = 0.01;      ///< expected offset of a line, mm; weighs as much as `prior_lines` lines
  double prior_lines = 1.0;
  double tilt_prior = 0.003;  ///< expected tilt of a line, rad; weighs as much as `prior_lines` lines
  double drift = 0.03;      ///< of the tracker, standard deviation, mm: what is slower than a sweep cannot be
                            ///< seen in the points and must be stated; faster drift is found by itself
  double drift_time = 1.0;  ///< its correlation time, s
  double cubic_share = 0.05;       ///< expected cubic coefficient: this times curvature^2 ...
  double cubic_floor = 1e-4;       ///< ... plus this, 1/mm^2
  double largest_curvature = 0.6;  ///< expected size of the strongest curvatures, 1/mm
};

/// z = sum of b_k times 1, x, y, x^2, xy, y^2, x^3, x^2 y, x y^2, y^3; mm.
struct Cubic {
  using Vector = Eigen::Matrix<double, 10, 1>;
  Vector b = Vector::Zero();

  static Vector features(double x, double y);
  static Eigen::Matrix<double, 2, 10> slope_features(double x, double y);
  double height(double x, double y) const { return b.dot(features(x, y)); }
  Eigen::Vector2d slope(double x, double y) const { return slope_features(x, y) * b; }
};

struct PatchSolution {
  bool solved = false;
  Cubic surface;
  Eigen::Matrix2d slope_covariance = Eigen::Matrix2d::Zero();  ///< at the frame's origin, rad^2
  double degrees_of_freedom = 0;                               ///< of the covariance's scale
  double offset_deviation = 0;                                 ///< of a line, as found, mm
  double drift_share = 0;                                      ///< expected share of drift in it, 0..1
  int lines = 0;                                               ///< with at least one used segment
};

/// Uses the segments with weight > 0. `quadric` is the robust fit of the same patch.
PatchSolution solve_patch(const Patch& patch, const Quadric& quadric, const SolutionOptions& options);

}  // namespace linescope
