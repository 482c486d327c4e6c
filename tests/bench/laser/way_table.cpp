#include "tests/bench/laser/way_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

namespace linescope::bench {

void print_table(const std::string& title, const std::vector<Way>& rows) {
  fmt::print("\n{}\n{:<52}{:>12}{:>12}{:>10}{:>10}\n", title, "", "median us", "fastest us", "x first",
             "x first");
  const auto fastest = [](const Way& way) { return *std::min_element(way.ns.begin(), way.ns.end()); };
  const double first_median = median(rows.front().ns), first_fastest = fastest(rows.front());
  for (const Way& way : rows)
    fmt::print("{:<52}{:>12.2f}{:>12.2f}{:>10.2f}{:>10.2f}\n", way.name, 1e-3 * median(way.ns),
               1e-3 * fastest(way), median(way.ns) / first_median, fastest(way) / first_fastest);
  std::fflush(stdout);
}

}  // namespace linescope::bench
