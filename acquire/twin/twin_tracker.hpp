// The twin's tracker: three sensors (endoscope, object, harvester on stations 0, 1, 2), 240 samples a second
// of each, with the noise of TwinOptions::tracker. Stepped: never sleeps.
#pragma once

#include <array>
#include <memory>
#include <mutex>

#include "acquire/tracker/tracker_source.hpp"
#include "acquire/twin/tracker_noise_model.hpp"
#include "acquire/twin/virtual_experiment.hpp"

namespace linescope::twin {

inline constexpr int kTwinStations = 3;

class TwinTracker : public TrackerSource {
 public:
  explicit TwinTracker(std::shared_ptr<const VirtualExperiment> experiment);

  Result<void> start() override;
  Result<Pull> next(PoseSample& out) override;
  bool live() const override { return false; }
  std::string description() const override;
  double nominal_hz() const override { return experiment_->options().tracker.rate_hz; }

  TrackerStatus status() const override;
  StationStatus station(int station) const override;
  TrackerCounters counters() const override;

 private:
  void publish(const PoseSample& sample);

  std::shared_ptr<const VirtualExperiment> experiment_;
  TrackerNoiseModel noise_;
  std::uint64_t cycle_ = 0;
  int next_station_ = 0;

  mutable std::mutex mutex_;  ///< guards what other threads may ask for
  bool started_ = false;
  bool ended_ = false;
  std::array<StationStatus, kMaxStations> stations_{};
  TrackerCounters counters_;
};

}  // namespace linescope::twin
