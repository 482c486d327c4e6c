#include "viewer/navigate/display_latency.hpp"

#include <algorithm>

namespace linescope {

void DisplayLatency::shown(Nanoseconds sampled, Nanoseconds shown_at) {
  if (sampled <= newest_ || shown_at < sampled) return;
  newest_ = sampled;
  took_[count_++ % kKept] = shown_at - sampled;
}

LatencySummary DisplayLatency::summary() const {
  LatencySummary result{.count = count_};
  auto sorted = took_;
  const std::size_t n = std::min<std::uint64_t>(count_, kKept);
  if (n == 0) return result;
  std::sort(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(n));
  result.p50 = sorted[n / 2];
  result.p95 = sorted[n - 1 - n / 20];
  result.max = sorted[n - 1];
  return result;
}

}  // namespace linescope
