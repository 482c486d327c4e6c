// The few statistics of the evaluation, on top of Boost.Math.
#pragma once

#include <optional>
#include <vector>

namespace linescope::evaluate {

/// A sample's mean, spread and the 95 % interval of the mean (Student).
struct Estimate {
  double mean = 0;
  double deviation = 0;   ///< standard deviation of the sample; 0 for one value
  double half_width = 0;  ///< the 95 % interval of the mean is mean +- this; infinite for one value
  int count = 0;
};

/// Nothing for an empty sample. Values that are not finite are left out.
std::optional<Estimate> estimate(const std::vector<double>& values);

/// Whether one more experiment of the same kind could well have given `value`: it lies within the 95 %
/// prediction interval of the sample. Two values or more.
bool could_be(const Estimate& sample, double value);

/// What a publication prints of a group.
struct GroupSummary {
  double mean = 0;
  double deviation = 0;
  int count = 0;
};

struct StudentTest {
  double t = 0;
  double degrees_of_freedom = 0;
  double p = 1;  ///< two-sided
};

/// Two-sample Student test with pooled variance, as the thesis used (5.3.2). Both groups need two values or
/// more.
StudentTest pooled_student(const GroupSummary& a, const GroupSummary& b);

/// Five numbers of a box plot.
struct Box {
  double low = 0, quarter = 0, median = 0, three_quarters = 0, high = 0;
};

/// Quartiles by linear interpolation; low and high are the extremes. `values` not empty.
Box box_of(std::vector<double> values);

}  // namespace linescope::evaluate
