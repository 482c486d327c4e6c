// One seeded virtual experiment: an endoscope, a phantom, a tracker and a hand. TwinCamera renders its
// pictures, TwinTracker its samples; both look at the same instants. Nothing here hands over coordinates of
// the surface: those are in the truth, which is for tests and evaluation only.
//
// Immutable after creation; any number of sources may share one, from any threads.
#pragma once

#include <memory>

#include "acquire/twin/laser_sheet.hpp"
#include "acquire/twin/twin_options.hpp"
#include "acquire/twin/twin_truth.hpp"
#include "common/calibration.hpp"

namespace linescope::twin {

class VirtualExperiment {
 public:
  /// Fails with one sentence when the options contradict themselves (validate(TwinOptions)).
  static Result<std::shared_ptr<const VirtualExperiment>> create(const TwinOptions& options);

  const TwinOptions& options() const { return options_; }

  /// What the best possible calibration of this instrument would find. Exact while the sheet is flat and the
  /// port does not refract; else the best fit of the calibration's own forms (pinhole with five coefficients,
  /// plane) over depths 8-22 mm.
  Calibration calibration() const { return calibration_; }

  const TwinTruth& truth() const { return truth_; }

  /// The light itself, for the renderer.
  const LaserSheet& sheet() const { return *sheet_; }

 private:
  VirtualExperiment(const TwinOptions& options, std::shared_ptr<const Phantom> phantom,
                    std::unique_ptr<LaserSheet> sheet);

  TwinOptions options_;
  TwinTruth truth_;
  Calibration calibration_;
  std::unique_ptr<LaserSheet> sheet_;
};

}  // namespace linescope::twin
