#include "tools/calibrate/least_squares.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

namespace linescope::calibrate {
namespace {

constexpr int kMostIterations = 60;
constexpr double kSmallGain = 1e-12;  ///< relative, of the sum of squares

Eigen::MatrixXd jacobian_at(const Residuals& residuals, const Eigen::VectorXd& x,
                            const Eigen::VectorXd& steps, Eigen::Index count) {
  Eigen::MatrixXd jacobian(count, x.size());
  Eigen::VectorXd plus(count), minus(count), at = x;
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    at(k) = x(k) + steps(k);
    residuals(at, plus);
    at(k) = x(k) - steps(k);
    residuals(at, minus);
    at(k) = x(k);
    jacobian.col(k) = (plus - minus) / (2 * steps(k));
  }
  return jacobian;
}

/// Inverse in units of the diagonal, so that millimetres and radians do not decide what counts as singular.
Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& normal) {
  const Eigen::VectorXd scale = normal.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * normal * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled);
  if (!(solver.eigenvalues()(0) > 1e-13))
    return Eigen::MatrixXd::Constant(normal.rows(), normal.cols(), std::numeric_limits<double>::quiet_NaN());
  const Eigen::MatrixXd inverse = solver.eigenvectors() * solver.eigenvalues().cwiseInverse().asDiagonal() *
                                  solver.eigenvectors().transpose();
  return scale.asDiagonal() * inverse * scale.asDiagonal();
}

}  // namespace

Fit least_squares(const Residuals& residuals, std::size_t count, Eigen::VectorXd start,
                  const Eigen::VectorXd& steps) {
  const auto rows = static_cast<Eigen::Index>(count);
  Fit fit;
  fit.unknowns = std::move(start);
  Eigen::VectorXd r(rows), tried(rows);
  residuals(fit.unknowns, r);
  fit.sum_of_squares = r.squaredNorm();
  double damping = 1e-3;
  Eigen::MatrixXd jacobian = jacobian_at(residuals, fit.unknowns, steps, rows);
  while (!fit.converged && fit.iterations < kMostIterations && damping < 1e12) {
    ++fit.iterations;
    const Eigen::MatrixXd normal = jacobian.transpose() * jacobian;
    Eigen::MatrixXd damped = normal;
    damped.diagonal() += damping * normal.diagonal().cwiseMax(1e-300);
    const Eigen::VectorXd next = fit.unknowns - damped.ldlt().solve(jacobian.transpose() * r);
    residuals(next, tried);
    const double sum = tried.squaredNorm();
    if (!(sum <= fit.sum_of_squares)) {
      damping *= 10;
      continue;
    }
    fit.converged = fit.sum_of_squares - sum <= kSmallGain * fit.sum_of_squares;
    fit.unknowns = next;
    fit.sum_of_squares = sum;
    r = tried;
    damping = std::max(1e-12, damping / 10);
    jacobian = jacobian_at(residuals, fit.unknowns, steps, rows);
  }
  fit.covariance = covariance_of(jacobian.transpose() * jacobian);
  return fit;
}

}  // namespace linescope::calibrate
