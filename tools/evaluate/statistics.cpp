#include "tools/evaluate/statistics.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

namespace linescope::evaluate {
namespace {

double student_quantile(int count) {
  return boost::math::quantile(boost::math::students_t(count - 1), 0.975);
}

double quantile(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], place - static_cast<double>(below));
}

}  // namespace

std::optional<Estimate> estimate(const std::vector<double>& values) {
  Estimate e;
  for (const double v : values) {
    if (!std::isfinite(v)) continue;
    e.mean += v;
    ++e.count;
  }
  if (e.count == 0) return std::nullopt;
  e.mean /= e.count;
  e.half_width = std::numeric_limits<double>::infinity();
  if (e.count == 1) return e;
  for (const double v : values)
    if (std::isfinite(v)) e.deviation += (v - e.mean) * (v - e.mean);
  e.deviation = std::sqrt(e.deviation / (e.count - 1));
  e.half_width = student_quantile(e.count) * e.deviation / std::sqrt(e.count);
  return e;
}

bool could_be(const Estimate& sample, double value) {
  const double width = student_quantile(sample.count) * sample.deviation * std::sqrt(1 + 1.0 / sample.count);
  return std::abs(value - sample.mean) <= width;
}

StudentTest pooled_student(const GroupSummary& a, const GroupSummary& b) {
  const double freedom = a.count + b.count - 2;
  const double squares =
      (a.count - 1) * a.deviation * a.deviation + (b.count - 1) * b.deviation * b.deviation;
  const double error = std::sqrt(squares / freedom * (1.0 / a.count + 1.0 / b.count));
  StudentTest test;
  test.degrees_of_freedom = freedom;
  test.t = (a.mean - b.mean) / error;
  const boost::math::students_t distribution(freedom);
  test.p = 2 * boost::math::cdf(boost::math::complement(distribution, std::abs(test.t)));
  return test;
}

Box box_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return {values.front(), quantile(values, 0.25), quantile(values, 0.5), quantile(values, 0.75),
          values.back()};
}

}  // namespace linescope::evaluate
