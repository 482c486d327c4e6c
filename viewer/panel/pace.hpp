// Percentiles of the last few hundred durations.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace linescope {

class PaceMeter {
 public:
  void add(double milliseconds) {
    if (values_.size() < kKept)
      values_.push_back(milliseconds);
    else
      values_[next_++ % kKept] = milliseconds;
  }
  double percentile(double fraction) const {
    if (values_.empty()) return 0;
    std::vector<double> sorted = values_;
    const auto at =
        sorted.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(sorted.size() - 1));
    std::nth_element(sorted.begin(), at, sorted.end());
    return *at;
  }

 private:
  static constexpr std::size_t kKept = 512;
  std::vector<double> values_;
  std::size_t next_ = 0;
};

}  // namespace linescope
