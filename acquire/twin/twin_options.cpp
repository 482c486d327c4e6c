#include "acquire/twin/twin_options.hpp"

#include <fmt/format.h>

#include <cmath>

#include "acquire/twin/laser_sheet.hpp"
#include "acquire/twin/lens.hpp"

namespace linescope::twin {
namespace {

// Row in which the flat sheet meets a wall at this depth, on the optical axis's column.
double row_at_gap(const InstrumentOptions& instrument, double gap) {
  const double down = gap * std::tan(instrument.alpha_rad) - instrument.baseline_mm;
  return Lens(instrument.lens).pixel({0, down / gap}).y();
}

Result<void> line_in_picture(const TwinOptions& options) {
  const double gap = options.hand.gap_mm;
  const double row = row_at_gap(options.instrument, gap);
  if (row >= 0 && row <= options.instrument.lens.height - 1) return {};
  return fail(
      ErrorCode::invalid,
      fmt::format(
          "at a gap of {:g} mm the laser line is out of the picture (row {:.0f} of {}): use a larger gap "
          "or another baseline and deviation",
          gap, row, options.instrument.lens.height));
}

}  // namespace

Result<void> apply_noise_preset(TwinOptions& options, std::string_view name) {
  const bool ideal = name == "ideal";
  if (!ideal && name != "manufacturer" && name != "thesis") {
    return fail(ErrorCode::usage,
                fmt::format("no noise preset is called '{}': use ideal, manufacturer or thesis", name));
  }
  options.tracker = *tracker_noise_from_name(name);
  options.optics = *optics_from_name(ideal ? "ideal" : "clean");
  if (ideal) options.instrument.lens.distortion = {};
  return {};
}

TwinOptions demo_twin() {
  TwinOptions options;
  options.instrument = *instrument_from_name("camera-ii");
  // A known name cannot fail.
  static_cast<void>(apply_noise_preset(options, "manufacturer"));
  return options;
}

Result<void> validate(const TwinOptions& options) {
  if (options.duration < 0)
    return fail(ErrorCode::invalid, "the experiment's duration must be 0 (endless) or more");
  for (const auto& valid : {validate(options.phantom), validate(options.instrument), validate(options.optics),
                            validate(options.tracker), validate(options.hand), line_in_picture(options)}) {
    if (!valid) return valid;
  }
  if (auto sheet = make_sheet(options.instrument, options.optics.prism); !sheet)
    return tl::unexpected(sheet.error());
  return {};
}

}  // namespace linescope::twin
