#include "ipc/segment_statistics.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace linescope {
namespace {

constexpr int kFirstOctave = 8;

std::uint64_t count_at(const ls_latency& h, double share) {
  std::uint64_t total = 0;
  for (const std::uint64_t n : h.buckets) total += n;
  return std::max<std::uint64_t>(1,
                                 static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(total))));
}

Nanoseconds percentile(const ls_latency& h, double share) {
  const std::uint64_t wanted = count_at(h, share);
  std::uint64_t below = 0;
  for (std::size_t i = 0; i < LS_LATENCY_BUCKETS; ++i) {
    below += h.buckets[i];
    if (below >= wanted) return static_cast<Nanoseconds>(std::min(latency_bucket_end(i), h.max_ns));
  }
  return static_cast<Nanoseconds>(h.max_ns);
}

}  // namespace

std::size_t latency_bucket(std::uint64_t ns) {
  if (ns < (1U << kFirstOctave)) return 0;
  const int octave = static_cast<int>(std::bit_width(ns)) - 1;
  const std::uint64_t quarter = (ns >> (octave - 2)) & 3U;
  const std::size_t bucket = 4U * static_cast<std::size_t>(octave - kFirstOctave) + quarter;
  return std::min<std::size_t>(bucket, LS_LATENCY_BUCKETS - 1);
}

std::uint64_t latency_bucket_end(std::size_t bucket) {
  if (bucket >= LS_LATENCY_BUCKETS - 1) return UINT64_MAX;
  const std::uint64_t octave = kFirstOctave + bucket / 4;
  return ((4U + bucket % 4 + 1) << (octave - 2)) - 1;
}

LatencyFigures latency_figures(const ls_latency& h) {
  LatencyFigures f;
  f.name.assign(h.name, strnlen(h.name, sizeof h.name));
  f.count = h.count;
  if (h.count == 0) return f;
  f.mean = static_cast<Nanoseconds>(h.sum_ns / h.count);
  f.p50 = percentile(h, 0.50);
  f.p95 = percentile(h, 0.95);
  f.p99 = percentile(h, 0.99);
  f.max = static_cast<Nanoseconds>(h.max_ns);
  f.last = static_cast<Nanoseconds>(h.last_ns);
  return f;
}

RateFigures rate_figures(std::span<const Nanoseconds> times) {
  RateFigures f;
  f.samples = times.size();
  if (times.size() < 2) return f;
  const auto n = static_cast<double>(times.size() - 1);
  f.period_mean_ms = (static_cast<double>(times.back()) - static_cast<double>(times.front())) * 1e-6 / n;
  double squares = 0;
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double period = (static_cast<double>(times[i]) - static_cast<double>(times[i - 1])) * 1e-6;
    squares += (period - f.period_mean_ms) * (period - f.period_mean_ms);
    f.period_max_ms = std::max(f.period_max_ms, period);
  }
  f.period_sd_ms = n > 1 ? std::sqrt(squares / (n - 1)) : 0;
  f.hz = f.period_mean_ms > 0 ? 1000.0 / f.period_mean_ms : 0;
  return f;
}

}  // namespace linescope
