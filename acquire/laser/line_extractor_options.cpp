#include "acquire/laser/line_extractor_options.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>

namespace linescope {

Result<void> validate(const LineExtractorOptions& o) {
  struct Range {
    std::string_view what;
    double value, least, most;
  };
  const std::array ranges{Range{"colour", static_cast<double>(o.colour), 1, 7},
                          Range{"colour_threshold", static_cast<double>(o.colour_threshold), 1, 254},
                          Range{"ridge_threshold", static_cast<double>(o.ridge_threshold), 0, 254},
                          Range{"ridge_reach", static_cast<double>(o.ridge_reach), 2, 256},
                          Range{"colour_ratio", o.colour_ratio, 1, 10},
                          Range{"merge_gap", static_cast<double>(o.merge_gap), 0, 32},
                          Range{"saturation_level", static_cast<double>(o.saturation_level), 128, 255},
                          Range{"min_width", o.min_width, 0, 1000},
                          Range{"max_width", o.max_width, o.min_width, 1000},
                          Range{"max_saturated", static_cast<double>(o.max_saturated), 0, 1000},
                          Range{"min_snr", o.min_snr, 0, 1000},
                          Range{"relative_threshold", o.relative_threshold, 0, 0.95},
                          Range{"border", static_cast<double>(o.border), 0, 1000},
                          Range{"min_run", static_cast<double>(o.min_run), 1, 10000},
                          Range{"max_step", o.max_step, 0.1, 1000},
                          Range{"max_gap", static_cast<double>(o.max_gap), 0, 64},
                          Range{"ambiguity", o.ambiguity, 0.1, 1}};
  for (const Range& r : ranges) {
    // Written so that NaN fails too.
    if (!(r.value >= r.least && r.value <= r.most)) {
      return fail(ErrorCode::invalid, fmt::format("line extraction: {} is {:g}, but must lie in {:g} .. {:g}",
                                                  r.what, r.value, r.least, r.most));
    }
  }
  return {};
}

}  // namespace linescope
