// From the covariance of a slope to statements about angles that hold in 95 of 100 cases.
#pragma once

#include <Eigen/Core>

namespace linescope {

/// Error of a normal as a tilt in its tangent plane: Student's distribution in two dimensions.
struct TiltError {
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< rad^2, the distribution's scale matrix
  double degrees_of_freedom = 1;
};

/// Half angle of the cone about the estimated normal that holds the true one with probability 0.95, radians.
double cone_95(const TiltError& error);

struct AngleInterval {
  double low = 0;
  double high = 0;
};

/// 95 % interval of the angle between axis and true normal. `tilt` is the axis seen from the estimated
/// normal: direction in the tangent plane, length = angle in radians. Profile interval: all angles that a
/// true normal within the error's ellipse could give; the ellipse is the one-dimensional one (1.96) far from
/// zero and grows to the two-dimensional one (2.45) where the angle is not larger than its error and the sign
/// of the tilt is lost.
AngleInterval angle_interval_95(const Eigen::Vector2d& tilt, const TiltError& error);

/// Quantile of Student's distribution, 0.975, for real degrees of freedom >= 1 (relative error below 2e-3).
double student_975(double degrees_of_freedom);

}  // namespace linescope
