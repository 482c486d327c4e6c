// From the figures of single seeds to the rows of a table.
#pragma once

#include <limits>
#include <vector>

#include "tools/evaluate/report.hpp"

namespace linescope::evaluate {

/// One figure of one seed, with both sets of algorithms; NaN: there is none.
struct SeedValue {
  double plain = std::numeric_limits<double>::quiet_NaN();
  double better = std::numeric_limits<double>::quiet_NaN();
};

/// All figures of one seed, in the order of the table's rows.
using SeedValues = std::vector<SeedValue>;

/// Fills the rows' estimates. Every seed has as many values as the table has rows.
inline void fill_rows(std::vector<Row>& rows, const std::vector<SeedValues>& seeds) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::vector<double> plain, better;
    for (const SeedValues& seed : seeds) {
      plain.push_back(seed[i].plain);
      better.push_back(seed[i].better);
    }
    rows[i].plain = estimate(plain);
    rows[i].better = estimate(better);
  }
}

}  // namespace linescope::evaluate
