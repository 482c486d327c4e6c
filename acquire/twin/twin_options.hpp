// Everything that decides a virtual experiment. The same options give the same pictures and samples, byte for
// byte.
#pragma once

#include <cstdint>

#include "acquire/twin/hand_options.hpp"
#include "acquire/twin/instrument_options.hpp"
#include "acquire/twin/optics_options.hpp"
#include "acquire/twin/phantom_kind.hpp"
#include "acquire/twin/tracker_options.hpp"
#include "common/result.hpp"
#include "common/time.hpp"

namespace linescope::twin {

struct TwinOptions {
  std::uint64_t seed = 1;
  Nanoseconds start = 0;     ///< CLOCK_MONOTONIC of the experiment's beginning; time stamps grow from here
  Nanoseconds duration = 0;  ///< after this the sources say `end`; 0 = never
  PhantomOptions phantom;
  InstrumentOptions instrument;
  OpticsOptions optics;
  TrackerNoise tracker;
  HandOptions hand;
};

/// Noise of a whole experiment by one name. "ideal": optics ideal, tracker ideal, no lens distortion.
/// "manufacturer": optics clean, tracker manufacturer (the demo's default). "thesis": optics clean, tracker
/// thesis. The sheet stays flat in all three: the bend that the prism must cause grows with the gap's square,
/// and Table 4.1 shows no such growth (docs/twin.md); optics_from_name("full") has it.
Result<void> apply_noise_preset(TwinOptions& options, std::string_view name);

/// The demo: condyle, camera II, preset "manufacturer", scenario demo.
TwinOptions demo_twin();

/// First fault in one sentence; also what only shows when all parts come together (a gap at which the line is
/// out of the picture, a prism with total reflection).
Result<void> validate(const TwinOptions& options);

}  // namespace linescope::twin
