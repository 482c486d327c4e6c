// Times alternatives in turn, round after round, so that whatever disturbs the machine hits all of them
// alike: only the ratios of such a run mean something.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace linescope::bench {

struct Alternative {
  std::string name;
  std::function<void()> run;
};

struct Timing {
  std::string name;
  double median_us = 0;
  double fastest_us = 0;
  std::vector<double> round_us{};  ///< every round's, in order
};

/// Runs every alternative once to warm up and then `rounds` times in turn.
std::vector<Timing> interleave(const std::vector<Alternative>& alternatives, int rounds);

/// Prints name, median, fastest, and both as multiples of the first row.
void print_table(const std::string& title, const std::vector<Timing>& rows);

/// Median of the rounds' ratios of `a` to `b`; rows by name. The machine may change its speed in the middle
/// of a run: within a round it is much the same for both.
double ratio(const std::vector<Timing>& rows, const std::string& a, const std::string& b);

/// Reads every byte once, as fast as plain code can: the limit for whatever looks at a whole picture.
unsigned long long read_pass(const void* bytes, unsigned long size);

}  // namespace linescope::bench
