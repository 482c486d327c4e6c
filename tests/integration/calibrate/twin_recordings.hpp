// What an operator records to calibrate an instrument, played by the digital twin.
#pragma once

#include <memory>

#include "acquire/twin/virtual_experiment.hpp"
#include "tools/calibrate/session.hpp"

namespace linescope::calibrate {

/// An instrument that nobody has calibrated: camera II, tip, axis, hand-eye and latency away from every
/// default. Noise of preset `manufacturer` without the field's distortion. One seed, one instrument.
twin::TwinOptions uncalibrated_instrument(std::uint64_t seed);

struct Recording {
  std::shared_ptr<const twin::VirtualExperiment> experiment;
  Session session;
};

/// Runs the twin for `seconds` and collects. `pictures`: false takes poses only.
Result<Recording> recorded(const twin::TwinOptions& options, double seconds, const CollectOptions& wants,
                           bool pictures = true);

/// Of the board in view after view, one picture each; of the board while the endoscope is shaken.
twin::TwinOptions before_board(twin::TwinOptions options, bool laser);
twin::TwinOptions shaken(twin::TwinOptions options);

BoardOptions printed_board();

}  // namespace linescope::calibrate
