#include "tests/bench/laser/interleaved.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <ctime>

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

}  // namespace

std::vector<Timing> interleave(const std::vector<Alternative>& alternatives, int rounds) {
  std::vector<std::vector<double>> times(alternatives.size());
  for (const Alternative& a : alternatives) a.run();
  for (int r = 0; r < rounds; ++r)
    for (std::size_t i = 0; i < alternatives.size(); ++i) times[i].push_back(seconds(alternatives[i].run));
  std::vector<Timing> out;
  for (std::size_t i = 0; i < alternatives.size(); ++i) {
    std::sort(times[i].begin(), times[i].end());
    out.push_back({alternatives[i].name, 1e6 * times[i][times[i].size() / 2], 1e6 * times[i].front()});
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
    return std::find_if(rows.begin(), rows.end(), [&](const Timing& t) { return t.name == name; })->median_us;
  };
  return find(a) / find(b);
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
