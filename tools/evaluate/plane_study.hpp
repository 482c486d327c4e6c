// A plane scanned at several gaps: the study behind Table 4.1 and its counterpart in air.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "acquire/twin/twin_options.hpp"
#include "tools/evaluate/form.hpp"
#include "tools/evaluate/report.hpp"

namespace linescope::evaluate {

struct PlaneGap {
  double gap_mm = 15;
  std::optional<double> thesis_error, thesis_deviation;  ///< mm
};

struct PlaneStudy {
  std::string id, title;
  std::vector<PlaneGap> gaps;
  std::optional<double> thesis_mean_error, thesis_mean_deviation;  ///< averages over the gaps
  std::function<twin::TwinOptions(std::uint64_t seed)> instrument;
};

/// Rows per gap: error (amount of the mean signed distance), SD, proportion; then averages, bias,
/// repeatability and reproducibility.
Result<Table> plane_table(const PlaneStudy& study, const Form& form);

}  // namespace linescope::evaluate
