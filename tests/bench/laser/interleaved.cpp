#include "tests/bench/laser/interleaved.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <utility>

namespace linescope::bench {
namespace {

/// Time this thread was given, not the time that passed: a neighbour that takes the processor does not count.
double thread_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double seconds(const std::function<void()>& run) {
  const double start = thread_seconds();
  run();
  return thread_seconds() - start;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

std::vector<Timing> interleave(const std::vector<Alternative>& alternatives, int rounds) {
  std::vector<Timing> out;
  for (const Alternative& a : alternatives) {
    a.run();
    out.push_back({.name = a.name});
  }
  for (int r = 0; r < rounds; ++r)
    for (std::size_t i = 0; i < alternatives.size(); ++i)
      out[i].round_us.push_back(1e6 * seconds(alternatives[i].run));
  for (Timing& t : out) {
    t.median_us = median(t.round_us);
    t.fastest_us = *std::min_element(t.round_us.begin(), t.round_us.end());
  }
  return out;
}

void print_table(const std::string& title, const std::vector<Timing>& rows) {
  fmt::print("\n{}\n{:<52}{:>12}{:>12}{:>10}{:>10}\n", title, "", "median us", "fastest us", "x first",
             "x first");
  for (const Timing& r : rows) {
    fmt::print("{:<52}{:>12.2f}{:>12.2f}{:>10.2f}{:>10.2f}\n", r.name, r.median_us, r.fastest_us,
               r.median_us / rows.front().median_us, r.fastest_us / rows.front().fastest_us);
  }
  std::fflush(stdout);
}

double ratio(const std::vector<Timing>& rows, const std::string& a, const std::string& b) {
  const auto find = [&](const std::string& name) {
    return std::find_if(rows.begin(), rows.end(), [&](const Timing& t) { return t.name == name; });
  };
  std::vector<double> ratios = find(a)->round_us;
  const std::vector<double>& other = find(b)->round_us;
  for (std::size_t i = 0; i < ratios.size(); ++i) ratios[i] /= other[i];
  return median(std::move(ratios));
}

__attribute__((target_clones("avx2", "default"), optimize("O3"))) unsigned long long read_pass(
    const void* bytes, unsigned long size) {
  constexpr std::size_t kLanes = 16;
  std::array<std::uint64_t, kLanes> lanes{};
  const auto* p = static_cast<const std::uint64_t*>(bytes);
  const std::size_t words = size / sizeof(std::uint64_t);
  for (std::size_t i = 0; i + kLanes <= words; i += kLanes)
    for (std::size_t k = 0; k < kLanes; ++k) lanes[k] ^= p[i + k];
  std::uint64_t all = 0;
  for (const std::uint64_t l : lanes) all ^= l;
  return all;
}

}  // namespace linescope::bench
