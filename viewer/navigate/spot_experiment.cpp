#include "viewer/navigate/spot_experiment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "viewer/navigate/angle_difference.hpp"

namespace linescope {
namespace {

SpotResult ask(const NormalEstimator& estimator, const Spot& spot, NormalMethod method) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const NormalEstimate estimate = estimator.estimate(spot.query, method);
  SpotResult result{estimate.reason, kNone, kNone, false, false, estimate.normal_uncertainty};
  if (!estimate.good()) return result;
  const double truth = angle_difference(spot.true_normal, spot.true_axis);
  result.normal_error = angle_difference(estimate.normal, spot.true_normal);
  result.angle_error = estimate.angle - truth;
  result.cone_holds = result.normal_error <= estimate.normal_uncertainty;
  result.interval_holds = truth >= estimate.angle_low && truth <= estimate.angle_high;
  return result;
}

void summarise(std::vector<double>& errors, SpotReport& report) {
  if (errors.empty()) return;
  std::sort(errors.begin(), errors.end());
  const auto n = static_cast<double>(errors.size());
  for (const double e : errors) report.mean += e / n;
  double squares = 0;
  for (const double e : errors) squares += (e - report.mean) * (e - report.mean);
  report.deviation = errors.size() > 1 ? std::sqrt(squares / (n - 1)) : 0;
  report.smallest = errors.front();
  report.largest = errors.back();
  report.percentile_95 = errors[static_cast<std::size_t>(std::ceil(0.95 * n)) - 1];
}

}  // namespace

SpotReport run_spots(const NormalEstimator& estimator, std::span<const Spot> spots, NormalMethod method) {
  SpotReport report;
  std::vector<double> errors;
  int cones = 0, intervals = 0;
  for (const Spot& spot : spots) {
    const SpotResult& result = report.spots.emplace_back(ask(estimator, spot, method));
    ++report.asked;
    if (result.reason != NormalReason::none) {
      ++report.refused[static_cast<std::size_t>(result.reason)];
      continue;
    }
    ++report.answered;
    errors.push_back(result.normal_error);
    report.mean_uncertainty += result.uncertainty;
    cones += result.cone_holds;
    intervals += result.interval_holds;
  }
  summarise(errors, report);
  const double n = std::max(1, report.answered);
  report.mean_uncertainty /= n;
  report.cone_coverage = cones / n;
  report.interval_coverage = intervals / n;
  return report;
}

SpotReport run_spots(std::span<const NavigationLine> lines, std::span<const Spot> spots,
                     const NormalEstimatorOptions& options) {
  NormalEstimator estimator(options);
  for (const NavigationLine& line : lines) estimator.add_line(line);
  return run_spots(estimator, spots, options.method);
}

}  // namespace linescope
