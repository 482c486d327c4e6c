// The twin's tracker: a LIBERTY with three sensors (endoscope, object, harvester on stations 0, 1, 2), 240
// cycles a second, with the noise of TwinOptions::tracker. Stepped: never sleeps.
//
// It goes the real device's way: every cycle becomes the bytes a LIBERTY sends, with an arrival time, and
// those go through the same parser, frame clock and station book-keeping (LibertyStream). So positions have
// the resolution of 32-bit floats (0.00004 mm at 350 mm), and time stamps come from the fitted clock.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "acquire/tracker/liberty/liberty_stream.hpp"
#include "acquire/tracker/tracker_source.hpp"
#include "acquire/twin/tracker_noise_model.hpp"
#include "acquire/twin/virtual_experiment.hpp"

namespace linescope::twin {

inline constexpr int kTwinStations = 3;

class TwinTracker : public TrackerSource, private SampleSink {
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
  bool over() const;
  void play_cycle();
  void append_station(int station, double seconds, Nanoseconds time);
  void publish(const PoseSample& sample);

  void on_sample(const PoseSample& sample) override { waiting_.push_back(sample); }
  void on_message(std::uint8_t, std::string_view) override {}  // the twin sends none

  std::shared_ptr<const VirtualExperiment> experiment_;
  TrackerNoiseModel noise_;
  LibertyOptions liberty_;
  std::optional<LibertyStream> stream_;
  std::vector<std::uint8_t> bytes_;  ///< of the present cycle
  std::deque<PoseSample> waiting_;   ///< parsed, not yet fetched
  std::uint64_t cycle_ = 0;

  mutable std::mutex mutex_;  ///< guards what other threads may ask for
  bool started_ = false;
  bool ended_ = false;
  std::array<StationStatus, kMaxStations> stations_{};
  TrackerCounters counters_;
};

}  // namespace linescope::twin
