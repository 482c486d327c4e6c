// Linear least squares over data that come three equations at a time and whose errors hang together for a
// while: A_i x = b_i.
//
// A hand slips and trembles, so neighbouring samples err alike. The covariance is therefore not taken from
// the scatter of single samples but from that of consecutive blocks (cluster-robust "sandwich", CR1): right
// for independent errors, for different sizes of error along different directions, and for errors that last
// shorter than a block.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

namespace linescope::calibrate {

struct TripleEquation {
  Eigen::Matrix<double, 3, Eigen::Dynamic> a;
  Eigen::Vector3d b;
};

struct BlockedFit {
  Eigen::VectorXd x;
  Eigen::MatrixXd covariance;
  std::vector<Eigen::Vector3d> residuals;  ///< of every equation, also of those left out
  double residual = 0;                     ///< RMS length over the equations used
  std::size_t used = 0;
};

inline constexpr std::size_t kFitBlocks = 40;

/// `use[i]`: whether equation i counts. Nothing when the equations do not determine x.
std::optional<BlockedFit> blocked_fit(const std::vector<TripleEquation>& equations,
                                      const std::vector<bool>& use);

/// Left-out equations: residual longer than `sigmas` times a robust standard deviation (median), found and
/// fitted again until nothing changes. `use` begins with all true.
std::optional<BlockedFit> robust_blocked_fit(const std::vector<TripleEquation>& equations,
                                             std::vector<bool>& use, double sigmas);

/// RMS length of the residuals of data that were in no fit: each fifth of the sequence against the fit of the
/// other four. NaN when a part does not determine x.
double held_out_rms(const std::vector<TripleEquation>& equations, const std::vector<bool>& use);

}  // namespace linescope::calibrate
