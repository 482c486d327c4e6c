#include "tools/calibrate/blocked_fit.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/calibrate/sample_statistics.hpp"

namespace linescope::calibrate {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kSingular = 1e-10;  // of the largest eigenvalue
constexpr int kRounds = 10;
constexpr int kParts = 5;

std::optional<MatrixXd> inverse_of(const MatrixXd& normal) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(normal);
  const VectorXd& values = solver.eigenvalues();
  if (!(values(0) > kSingular * values(values.size() - 1))) return std::nullopt;
  return MatrixXd(solver.eigenvectors() * values.cwiseInverse().asDiagonal() *
                  solver.eigenvectors().transpose());
}

/// Sum over blocks of g gT, where g is the sum of AT r of the block's used equations.
MatrixXd block_scatter(const std::vector<TripleEquation>& equations, const std::vector<bool>& use,
                       const std::vector<Eigen::Vector3d>& residuals, std::size_t blocks) {
  const Eigen::Index unknowns = equations.front().a.cols();
  MatrixXd scatter = MatrixXd::Zero(unknowns, unknowns);
  for (std::size_t block = 0; block < blocks; ++block) {
    VectorXd sum = VectorXd::Zero(unknowns);
    const std::size_t end = (block + 1) * equations.size() / blocks;
    for (std::size_t i = block * equations.size() / blocks; i < end; ++i) {
      if (use[i]) sum += equations[i].a.transpose() * residuals[i];
    }
    scatter += sum * sum.transpose();
  }
  return scatter;
}

double robust_deviation(const std::vector<Eigen::Vector3d>& residuals, const std::vector<bool>& use) {
  std::vector<double> lengths;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    if (use[i]) lengths.push_back(residuals[i].norm());
  }
  return median_of(std::move(lengths)) /
         1.538;  // the median length of a three-dimensional standard normal vector
}

}  // namespace

std::optional<BlockedFit> blocked_fit(const std::vector<TripleEquation>& equations,
                                      const std::vector<bool>& use) {
  if (equations.empty()) return std::nullopt;
  const Eigen::Index unknowns = equations.front().a.cols();
  MatrixXd normal = MatrixXd::Zero(unknowns, unknowns);
  VectorXd right = VectorXd::Zero(unknowns);
  BlockedFit fit;
  for (std::size_t i = 0; i < equations.size(); ++i) {
    if (!use[i]) continue;
    normal += equations[i].a.transpose() * equations[i].a;
    right += equations[i].a.transpose() * equations[i].b;
    ++fit.used;
  }
  const auto inverse = inverse_of(normal);
  if (!inverse || 3 * fit.used <= static_cast<std::size_t>(unknowns)) return std::nullopt;
  fit.x = *inverse * right;
  double squares = 0;
  for (std::size_t i = 0; i < equations.size(); ++i) {
    fit.residuals.emplace_back(equations[i].a * fit.x - equations[i].b);
    if (use[i]) squares += fit.residuals.back().squaredNorm();
  }
  fit.residual = std::sqrt(squares / static_cast<double>(fit.used));
  const std::size_t blocks = std::min(kFitBlocks, equations.size());
  const double small_sample = static_cast<double>(blocks) /
                              std::max(1.0, static_cast<double>(blocks) - static_cast<double>(unknowns) / 3);
  fit.covariance =
      small_sample * (*inverse) * block_scatter(equations, use, fit.residuals, blocks) * (*inverse);
  return fit;
}

std::optional<BlockedFit> robust_blocked_fit(const std::vector<TripleEquation>& equations,
                                             std::vector<bool>& use, double sigmas) {
  auto fit = blocked_fit(equations, use);
  for (int round = 0; fit && round < kRounds; ++round) {
    const double limit = sigmas * robust_deviation(fit->residuals, use) + 1e-9;
    std::vector<bool> next(use.size());
    for (std::size_t i = 0; i < use.size(); ++i) next[i] = fit->residuals[i].norm() <= limit;
    if (next == use) break;
    use = next;
    fit = blocked_fit(equations, use);
  }
  return fit;
}

double held_out_rms(const std::vector<TripleEquation>& equations, const std::vector<bool>& use) {
  double squares = 0, count = 0;
  for (std::size_t part = 0; part < kParts; ++part) {
    const std::size_t begin = part * equations.size() / kParts, end = (part + 1) * equations.size() / kParts;
    std::vector<bool> others = use;
    for (std::size_t i = begin; i < end; ++i) others[i] = false;
    const auto fit = blocked_fit(equations, others);
    if (!fit) return std::numeric_limits<double>::quiet_NaN();
    for (std::size_t i = begin; i < end; ++i) {
      if (!use[i]) continue;
      squares += fit->residuals[i].squaredNorm();
      ++count;
    }
  }
  return std::sqrt(squares / count);
}

}  // namespace linescope::calibrate
