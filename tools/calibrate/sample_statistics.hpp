// Small statistics that several fits need.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "tools/calibrate/verdict.hpp"

namespace linescope::calibrate {

/// The upper one of two middle values. Precondition: not empty.
inline double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The value that 98 of 100 do not exceed: what a scale has to hold when a few outliers shall not take all of
/// it. Precondition: not empty.
inline double high_value(std::vector<double> values) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() * 98 / 100);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Standard deviation of an estimate, from the estimates value(0), value(1), ... that each lack one group of
/// the data (jackknife). Nothing is known of a single one.
template <class Value>
double jackknife_deviation(std::size_t count, Value&& value) {
  const auto n = static_cast<double>(count);
  double mean = 0, squares = 0;
  for (std::size_t i = 0; i < count; ++i) mean += value(i) / n;
  for (std::size_t i = 0; i < count; ++i) squares += std::pow(value(i) - mean, 2);
  return count > 1 ? std::sqrt((n - 1) / n * squares) : kUnknown;
}

/// The worst of some errors, where it stands out.
struct Outlier {
  std::size_t at = 0;
  double error = 0;
  double usual = 0;  ///< median of all
};

/// Nothing when the worst error is at most `factor` times the median, or at most `always_good`.
inline std::optional<Outlier> outlier_among(const std::vector<double>& errors, double factor,
                                            double always_good = 0) {
  if (errors.empty()) return std::nullopt;
  const auto worst = std::max_element(errors.begin(), errors.end());
  const double usual = median_of(errors);
  if (*worst <= std::max(always_good, factor * usual)) return std::nullopt;
  return Outlier{static_cast<std::size_t>(worst - errors.begin()), *worst, usual};
}

}  // namespace linescope::calibrate
