#include "viewer/navigate/patch_solution.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "viewer/navigate/line_groups.hpp"

namespace linescope {
namespace {

using Vector = Cubic::Vector;
using Matrix = Eigen::Matrix<double, 10, 10>;

/// Offsets of lines: variance that is new with every line, and stationary variance of the drift, both in
/// mm^2.
struct OffsetModel {
  double fresh = 0;
  double drift = 0;
  double log_prior = 0;
};

/// Tried, as parts of the offsets' first estimate and on top of the stated drift, and how likely each is
/// beforehand.
constexpr std::array<OffsetModel, 4> kModels{
    {{1.0, 0.0, -0.3}, {0.8, 0.8, -1.9}, {0.5, 3.0, -2.6}, {0.2, 8.0, -3.0}}};

struct Normal {
  Matrix left = Matrix::Zero();
  Vector right = Vector::Zero();

  void add(const Vector& row, double value, double weight) {
    left.selfadjointView<Eigen::Lower>().rankUpdate(row, weight);
    right.noalias() += weight * value * row;
  }
};

struct Candidate {
  Vector b = Vector::Zero();
  Matrix covariance = Matrix::Zero();
  double log_likelihood = 0;
  double scale = 1;
};

/// Kalman filter over the lines' offsets in time order: turns correlated rows into independent ones
/// (innovations).
template <class Take>
void whiten(const LineGroups& groups, const OffsetModel& model, double drift_time, Take&& take) {
  Eigen::Matrix<double, 11, 1> state = Eigen::Matrix<double, 11, 1>::Zero();
  double variance = model.drift;
  for (int i = 0; i < groups.size; ++i) {
    const LineGroup& line = groups.in_time(i);
    if (i > 0) {
      const double passed = seconds_from(line.time - groups.in_time(i - 1).time);
      const double kept = std::exp(-passed / drift_time);
      state *= kept;
      variance = kept * kept * variance + model.drift * (1 - kept * kept);
    }
    const double total = variance + model.fresh + line.offset_variance;
    const Eigen::Matrix<double, 11, 1> innovation = line.offset_row - state;
    take(innovation, total);
    const double gain = variance / total;
    state += gain * innovation;
    variance -= gain * variance;
  }
}

class Solver {
 public:
  Solver(const Patch& patch, const Quadric& quadric, const SolutionOptions& options)
      : options_(options), curvature_(quadric.curvature()), groups_(patch, quadric, options.segment_floor) {
    Vector first = Vector::Zero();
    first.head<6>() = quadric.b;
    measure_noise(first);
    // Once more with the surface this gives: what the robust quadric could not follow is no noise.
    measure_noise(evaluate(scaled(kModels[0], offset_variance_)).b);
  }

  PatchSolution solve() const {
    PatchSolution result;
    result.lines = groups_.size;
    std::array<Candidate, kModels.size()> candidates;
    for (std::size_t k = 0; k < kModels.size(); ++k) {
      const double scale = evaluate(scaled(kModels[k], offset_variance_)).scale;
      candidates[k] = evaluate(scaled(kModels[k], offset_variance_ * scale));
      candidates[k].log_likelihood += kModels[k].log_prior;
    }
    combine(candidates, result);
    return result;
  }

 private:
  OffsetModel scaled(const OffsetModel& parts, double variance) const {
    return {parts.fresh * variance, parts.drift * variance + options_.drift * options_.drift};
  }

  void measure_noise(const Vector& surface) {
    groups_.scale_to(surface);
    double offsets = 0, tilts = 0;
    int tilted = 0;
    const double usual_tilt = options_.tilt_prior * options_.tilt_prior;
    for (int i = 0; i < groups_.size; ++i) {
      const LineGroup& line = groups_.in_time(i);
      const double e = line.offset_row[10] - line.offset_row.head<10>().dot(surface);
      offsets += e * e - line.offset_variance;
      if (!(line.tilt_variance > 0)) continue;
      const double t = line.tilt_row[10] - line.tilt_row.head<10>().dot(surface);
      tilts += (t * t - line.tilt_variance) / (1 + line.tilt_variance / usual_tilt);
      ++tilted;
    }
    const double prior = options_.prior_lines;
    offset_variance_ = (prior * options_.line_prior * options_.line_prior + std::max(0.0, offsets)) /
                       (prior + std::max(1, groups_.size - 3));
    tilt_variance_ = (prior * usual_tilt + std::max(0.0, tilts)) / (prior + std::max(0, tilted - 2));
    gather_common_part();
  }

  /// What all models of the offsets share: within lines, tilts of lines, expectation of curvature and cubic
  /// terms.
  void gather_common_part() {
    common_.left = groups_.within.topLeftCorner<10, 10>() / groups_.segment_factor;
    common_.right = groups_.within.bottomLeftCorner<1, 10>().transpose() / groups_.segment_factor;
    for (int i = 0; i < groups_.size; ++i) {
      const LineGroup& line = groups_.in_time(i);
      if (line.tilt_variance > 0)
        common_.add(line.tilt_row.head<10>(), line.tilt_row[10], 1 / (line.tilt_variance + tilt_variance_));
    }
    const double cubic = options_.cubic_share * curvature_ * curvature_ + options_.cubic_floor;
    const double tight = 1 / (cubic * cubic),
                 loose = 1 / (options_.largest_curvature * options_.largest_curvature);
    common_.left.diagonal().tail<7>() +=
        (Eigen::Matrix<double, 7, 1>() << 4 * loose, loose, 4 * loose, tight, tight / 3, tight / 3, tight)
            .finished();
  }

  Candidate evaluate(const OffsetModel& model) const {
    Candidate result;
    Normal normal = common_;
    double log_variances = 0, squares = 0;
    Vector cross = Vector::Zero();
    Matrix offset_left = Matrix::Zero();
    whiten(groups_, model, options_.drift_time,
           [&](const Eigen::Matrix<double, 11, 1>& row, double variance) {
             const double weight = 1 / variance;
             offset_left.selfadjointView<Eigen::Lower>().rankUpdate(row.head<10>(), weight);
             cross += (weight * row[10]) * row.head<10>();
             squares += weight * row[10] * row[10];
             log_variances += std::log(variance);
           });
    normal.left += offset_left;
    normal.right += cross;
    const Eigen::LDLT<Matrix, Eigen::Lower> factor(normal.left);
    result.b = factor.solve(normal.right);
    result.covariance = factor.solve(Matrix::Identity());
    const double offset_squares = squares - 2 * result.b.dot(cross) +
                                  result.b.dot(offset_left.selfadjointView<Eigen::Lower>() * result.b);
    const double common_squares = result.b.dot(common_.left.selfadjointView<Eigen::Lower>() * result.b) -
                                  2 * result.b.dot(common_.right);
    const double freedom = std::max(1.0, groups_.size - 3.0) + options_.prior_lines;
    result.scale = (options_.prior_lines + offset_squares) / freedom;
    result.log_likelihood =
        -0.5 * (log_variances + offset_squares + common_squares + factor.vectorD().array().log().sum());
    return result;
  }

  void combine(const std::array<Candidate, kModels.size()>& candidates, PatchSolution& result) const {
    double best = candidates[0].log_likelihood;
    for (const Candidate& c : candidates) best = std::max(best, c.log_likelihood);
    double total = 0;
    for (const Candidate& c : candidates) total += std::exp(c.log_likelihood - best);
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      const double p = std::exp(candidates[k].log_likelihood - best) / total;
      result.surface.b += p * candidates[k].b;
      result.drift_share += p * kModels[k].drift / (kModels[k].fresh + kModels[k].drift);
    }
    for (const Candidate& c : candidates) {
      const double p = std::exp(c.log_likelihood - best) / total;
      const Eigen::Vector2d apart = (c.b - result.surface.b).segment<2>(1);
      result.slope_covariance += p * (c.covariance.block<2, 2>(1, 1) + apart * apart.transpose());
    }
    result.degrees_of_freedom = std::max(1.0, groups_.size - 3.0) + options_.prior_lines;
    result.offset_deviation = std::sqrt(offset_variance_);
    result.solved = result.surface.b.allFinite() && result.slope_covariance.allFinite();
  }

  SolutionOptions options_;
  double curvature_;
  LineGroups groups_;
  Normal common_;
  double offset_variance_ = 0;
  double tilt_variance_ = 0;
};

}  // namespace

Vector Cubic::features(double x, double y) {
  Vector f;
  f << 1, x, y, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y;
  return f;
}

Eigen::Matrix<double, 2, 10> Cubic::slope_features(double x, double y) {
  Eigen::Matrix<double, 2, 10> f;
  f << 0, 1, 0, 2 * x, y, 0, 3 * x * x, 2 * x * y, y * y, 0,  //
      0, 0, 1, 0, x, 2 * y, 0, x * x, 2 * x * y, 3 * y * y;
  return f;
}

PatchSolution solve_patch(const Patch& patch, const Quadric& quadric, const SolutionOptions& options) {
  if (quadric.used < 6) return {};
  return Solver(patch, quadric, options).solve();
}

}  // namespace linescope
