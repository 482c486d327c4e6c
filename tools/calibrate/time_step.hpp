// Step `time`: latency of the camera on the tracker's clock, from filming the board while the endoscope
// moves.
#pragma once

#include "tools/calibrate/latency_fit.hpp"
#include "tools/calibrate/step.hpp"

namespace linescope::calibrate {

class TimeStep : public Step {
 public:
  std::string_view name() const override { return "time"; }
  std::string_view about() const override {
    return "Camera-to-tracker latency: film the resting board for ten seconds while turning the endoscope to "
           "and fro.";
  }
  void declare(ConfigSchema& schema) override;
  Result<void> validate() const override { return calibrate::validate(options_); }
  CollectOptions wants(const BoardOptions& board) const override;
  std::string coverage(const Session& so_far, const BoardOptions& board) const override;
  Result<Outcome> run(const Session& session, const BoardOptions& board,
                      const Calibration& before) const override;

  LatencyOptions& options() { return options_; }

 private:
  LatencyOptions options_;
};

}  // namespace linescope::calibrate
