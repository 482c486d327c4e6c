// Times several ways in turn within one run, so that their ratios do not depend on the state of the machine.
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

#include "common/time.hpp"

namespace linescope::bench {

inline double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}
inline double median(const std::vector<double>& values) {
  return quantile(values, 0.5);
}

struct Way {
  std::string name;
  std::function<void()> run;
  std::vector<double> ns{};
};

/// Processor time of this thread: neighbours on the machine take time from the clock on the wall, not from
/// this one.
inline Nanoseconds processor_now() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<Nanoseconds>(t.tv_sec) * kSecond + t.tv_nsec;
}

/// Every way once per round, in turn; the first two rounds only warm up.
inline void run_in_turn(std::vector<Way>& ways, int rounds) {
  for (int round = 0; round < rounds + 2; ++round) {
    for (Way& way : ways) {
      const Nanoseconds start = processor_now();
      way.run();
      if (round >= 2) way.ns.push_back(static_cast<double>(processor_now() - start));
    }
  }
}

/// Median of the quotients of the same round: what both saw of the machine cancels out.
inline double ratio(const Way& a, const Way& b) {
  std::vector<double> quotients;
  for (std::size_t i = 0; i < a.ns.size(); ++i) quotients.push_back(a.ns[i] / b.ns[i]);
  return median(quotients);
}

/// A counter per way (ns per unit), to be shown by Google Benchmark.
inline void report(benchmark::State& state, const std::vector<Way>& ways, double units) {
  for (const Way& way : ways) state.counters[way.name + "_ns"] = median(way.ns) / units;
}

}  // namespace linescope::bench
