#include "tools/evaluate/setups.hpp"

#include <algorithm>
#include <utility>

#include "common/time.hpp"

namespace linescope::evaluate {
namespace {

constexpr double kSweepSeconds = 1.5;  // thesis: 1.47 s for 200 mm^2

twin::TwinOptions thesis_noise(const char* instrument, std::uint64_t seed) {
  twin::TwinOptions options;
  options.seed = seed;
  options.instrument = *twin::instrument_from_name(instrument);
  // Known names cannot fail.
  static_cast<void>(twin::apply_noise_preset(options, "thesis"));
  options.hand.scenario = twin::Scenario::sweeps;
  options.hand.sweep_seconds = kSweepSeconds;
  return options;
}

}  // namespace

twin::TwinOptions system_ii(std::uint64_t seed) {
  return thesis_noise("camera-ii", seed);
}

twin::TwinOptions system_i(std::uint64_t seed) {
  twin::TwinOptions options = thesis_noise("camera-i", seed);
  options.instrument.baseline_mm = 5.0;
  options.optics.prism.medium_index = 1.0;
  return options;
}

twin::TwinOptions with_bent_sheet(twin::TwinOptions options) {
  options.optics.prism.refracted_sheet = true;
  return options;
}

twin::TwinOptions sweeping(twin::TwinOptions options, double gap_mm, double seconds) {
  options.hand.gap_mm = gap_mm;
  options.hand.gap_variation_mm = 0;
  options.hand.sweep_seconds = std::min(kSweepSeconds, seconds / 2);
  options.duration = nanoseconds_from_seconds(seconds);
  return options;
}

twin::TwinOptions sweeping_freely(twin::TwinOptions options, double seconds) {
  options = sweeping(std::move(options), 15, seconds);
  options.hand.gap_variation_mm = 4;
  return options;
}

twin::PhantomOptions phantom(const char* name) {
  return *twin::phantom_from_name(name);
}

}  // namespace linescope::evaluate
