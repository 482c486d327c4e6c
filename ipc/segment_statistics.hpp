// Figures a reader derives from the segment: counters by name, latency percentiles, measured rates.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "common/time.hpp"
#include "ipc/segment_layout.h"

namespace linescope {

struct CounterValue {
  std::string name;
  std::uint64_t value = 0;
};

/// Percentiles are the upper edges of their buckets (at most 25 % too large), never more than the largest
/// value seen.
struct LatencyFigures {
  std::string name;
  std::uint64_t count = 0;
  Nanoseconds mean = 0, p50 = 0, p95 = 0, p99 = 0, max = 0, last = 0;
};

/// Of a series of times: how many, mean frequency, spread of the period.
struct RateFigures {
  std::uint64_t samples = 0;  ///< of the history looked at
  double hz = 0;              ///< 0: fewer than two samples
  double period_mean_ms = 0;
  double period_sd_ms = 0;
  double period_max_ms = 0;
};

/// Bucket of the latency histogram a duration falls into, and the largest duration of a bucket (both as in
/// ls_latency).
std::size_t latency_bucket(std::uint64_t ns);
std::uint64_t latency_bucket_end(std::size_t bucket);

LatencyFigures latency_figures(const ls_latency& histogram);
RateFigures rate_figures(std::span<const Nanoseconds> times);

}  // namespace linescope
