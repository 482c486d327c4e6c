#include "viewer/navigate/patch_solution.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "viewer/navigate/line_groups.hpp"
#include "viewer/navigate/row_sums.hpp"

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
    {{1.0, 0.0, -0.05}, {0.8, 0.8, -3.7}, {0.5, 3.0, -4.4}, {0.2, 8.0, -4.8}}};

struct Candidate {
  Vector b = Vector::Zero();
  Eigen::Matrix2d slope_covariance = Eigen::Matrix2d::Zero();
  double log_likelihood = 0;
};

/// Sum of logarithms, a logarithm every eight values; these are between 1e-30 and 1e30.
class LogSum {
 public:
  void add(double value) {
    product_ *= value;
    if (++count_ % 8 == 0) fold();
  }
  double total() {
    fold();
    return sum_;
  }

 private:
  void fold() {
    sum_ += std::log(product_);
    product_ = 1;
  }
  double sum_ = 0;
  double product_ = 1;
  int count_ = 0;
};

/// Kalman filter over the lines' offsets in time order: turns what is correlated into independent
/// innovations. `state` starts as zero, `value(i)` is line i's; take(i, innovation, its variance).
template <class State, class Value, class Take>
void whiten(const LineGroups& groups, std::span<const double> kept, const OffsetModel& model, State state,
            Value&& value, Take&& take) {
  double variance = model.drift;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    state *= kept[i];
    variance = kept[i] * kept[i] * variance + model.drift * (1 - kept[i] * kept[i]);
    const double total = variance + model.fresh + groups.lines[i].offset_variance;
    const State innovation = value(i) - state;
    take(i, innovation, total);
    state += (variance / total) * innovation;
    variance -= variance / total * variance;
  }
}

class Solver {
 public:
  Solver(const Patch& patch, const Quadric& quadric, const SolutionOptions& options)
      : options_(options), curvature_(quadric.curvature()), groups_(patch, quadric, options.segment_floor) {
    Vector first = Vector::Zero();
    first.head<6>() = quadric.b;
    keep_times();
    measure_noise(first);
    // Once more with the surface this gives: what the robust quadric could not follow is no noise.
    measure_noise(evaluate(scaled(kModels[0], offset_variance_)).b);
  }

  PatchSolution solve() {
    PatchSolution result;
    result.lines = groups_.size;
    std::array<Candidate, kModels.size()> candidates;
    for (std::size_t k = 0; k < kModels.size(); ++k) {
      const double scale = scale_of(scaled(kModels[k], offset_variance_));
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

  /// How much of the drift is kept from one line to the next.
  void keep_times() {
    kept_[0] = 1;
    for (int i = 1; i < groups_.size; ++i) {
      const double passed = seconds_from(groups_.in_time(i).time - groups_.in_time(i - 1).time);
      kept_[static_cast<std::size_t>(i)] = std::exp(-passed / options_.drift_time);
    }
  }
  std::span<const double> kept() const {
    return std::span(kept_).first(static_cast<std::size_t>(groups_.size));
  }

  void measure_noise(const Vector& surface) {
    groups_.scale_to(surface);
    double offsets = 0, tilts = 0;
    int tilted = 0;
    const double usual_tilt = options_.tilt_prior * options_.tilt_prior;
    for (int i = 0; i < groups_.size; ++i) {
      const LineGroup& line = groups_.in_time(i);
      const double e = line.offset_row[10] - line.offset_row.head<10>().dot(surface);
      offset_residuals_[static_cast<std::size_t>(i)] = e;
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
    common_ = groups_.within / groups_.segment_factor;
    std::size_t n = 0;
    for (int i = 0; i < groups_.size; ++i) {
      const LineGroup& line = groups_.in_time(i);
      if (!(line.tilt_variance > 0)) continue;
      rows_[n] = line.tilt_row;
      weights_[n++] = 1 / (line.tilt_variance + tilt_variance_);
    }
    add_rows(rows_.data(), weights_.data(), n, common_);
    const double cubic = options_.cubic_share * curvature_ * curvature_ + options_.cubic_floor;
    const double tight = 1 / (cubic * cubic);
    const double loose = 1 / (options_.largest_curvature * options_.largest_curvature);
    Eigen::Matrix<double, 7, 1> expected;
    expected << 4 * loose, loose, 4 * loose, tight, tight / 3, tight / 3, tight;
    common_.diagonal().segment<7>(3) += expected;
  }

  /// How much larger the offsets are than a model says, by the residuals from the surface found so far.
  double scale_of(const OffsetModel& model) const {
    double squares = 0;
    whiten(
        groups_, kept(), model, 0.0, [this](std::size_t i) { return offset_residuals_[i]; },
        [&](std::size_t, double innovation, double variance) {
          squares += innovation * innovation / variance;
        });
    return (options_.prior_lines + squares) / freedom();
  }

  double freedom() const { return std::max(1.0, groups_.size - 3.0) + options_.prior_lines; }

  Candidate evaluate(const OffsetModel& model) {
    LogSum log_variances;
    whiten(
        groups_, kept(), model, FitRow(FitRow::Zero()),
        [this](std::size_t i) -> const FitRow& { return groups_.lines[i].offset_row; },
        [&](std::size_t i, const FitRow& innovation, double variance) {
          rows_[i] = innovation;
          weights_[i] = 1 / variance;
          log_variances.add(variance);
        });
    RowSums sums = common_;
    add_rows(rows_.data(), weights_.data(), static_cast<std::size_t>(groups_.size), sums);

    Candidate result;
    const Eigen::LLT<Matrix, Eigen::Lower> factor(sums.topLeftCorner<10, 10>());
    if (factor.info() != Eigen::Success) {
      result.log_likelihood = -std::numeric_limits<double>::infinity();
      return result;
    }
    Eigen::Matrix<double, 10, 3> right = Eigen::Matrix<double, 10, 3>::Zero();
    right.col(0) = sums.row(10).head<10>().transpose();
    right(1, 1) = right(2, 2) = 1;
    factor.solveInPlace(right);
    result.b = right.col(0);
    result.slope_covariance = right.block<2, 2>(1, 1);
    LogSum log_determinant;
    for (int i = 0; i < 10; ++i) log_determinant.add(factor.matrixLLT()(i, i));
    result.log_likelihood =
        -0.5 * (log_variances.total() + squares_about(sums, result.b)) - log_determinant.total();
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
      result.slope_covariance += p * (c.slope_covariance + apart * apart.transpose());
    }
    result.degrees_of_freedom = freedom();
    result.offset_deviation = std::sqrt(offset_variance_);
    result.solved =
        std::isfinite(best) && result.surface.b.allFinite() && result.slope_covariance.allFinite();
  }

  SolutionOptions options_;
  double curvature_;
  LineGroups groups_;
  RowSums common_ = RowSums::Zero();
  std::array<double, Patch::kMostLines> kept_;
  std::array<double, Patch::kMostLines> offset_residuals_;
  std::array<FitRow, Patch::kMostLines> rows_;
  std::array<double, Patch::kMostLines> weights_;
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
