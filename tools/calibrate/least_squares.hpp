// A small dense least-squares solver: Levenberg-Marquardt with differences instead of derivatives. For the
// few dozen unknowns of a calibration.
#pragma once

#include <Eigen/Core>
#include <functional>

namespace linescope::calibrate {

/// Residuals of a set of unknowns, already divided by their standard deviations. The length never changes.
using Residuals = std::function<void(const Eigen::VectorXd& unknowns, Eigen::VectorXd& residuals)>;

struct Fit {
  Eigen::VectorXd unknowns;
  Eigen::MatrixXd covariance;  ///< of the unknowns for residuals of variance one; NaN: not determined
  double sum_of_squares = 0;
  int iterations = 0;
  bool converged = false;
};

/// `steps`: size of the differences per unknown, about a thousandth of what matters.
Fit least_squares(const Residuals& residuals, std::size_t count, Eigen::VectorXd start,
                  const Eigen::VectorXd& steps);

}  // namespace linescope::calibrate
