// From a LIBERTY's bytes to pose samples: everything between the transport and the source, without threads
// and clocks of its own, so that tests, the fuzzer and the benchmark drive it directly.
#pragma once

#include <array>
#include <memory>

#include "acquire/tracker/frame_sequence.hpp"
#include "acquire/tracker/liberty/liberty_options.hpp"
#include "acquire/tracker/liberty/liberty_record.hpp"
#include "common/pose_sample.hpp"

namespace linescope {

/// Receives samples during LibertyStream::feed(), in the order of the stream.
class SampleSink {
 public:
  virtual ~SampleSink() = default;
  virtual void on_sample(const PoseSample& sample) = 0;
  /// An error message of the unit in the middle of the stream.
  virtual void on_message(std::uint8_t error, std::string_view text) = 0;
};

struct StationFigures {
  ToolState state = ToolState::never_seen;
  std::uint8_t error = 0;  ///< error indicator of the newest record
  bool minor_distortion = false;
  bool silent = false;  ///< it was there, and its records stopped coming
  std::uint64_t lost = 0;
};

struct StreamCounters {
  ParserCounters parser;
  std::uint64_t lost = 0;             ///< samples missing by frame count
  std::uint64_t out_of_order = 0;     ///< twice the same frame, or an earlier one
  std::uint64_t doubtful_counts = 0;  ///< records dropped for a frame count that made no sense
  std::uint64_t device_errors = 0;    ///< records and messages with an error code
  std::uint64_t epochs = 0;           ///< times the frame count began anew, the first included
};

/// A station whose sensor was unplugged (no record while the others went on for `missing_after` cycles) gives
/// one sample in state `missing`, and a whole one again when it is back. Allocates nothing per sample.
class LibertyStream : private LibertySink {
 public:
  /// Precondition: validate(options) holds.
  explicit LibertyStream(const LibertyOptions& options);

  void feed(std::span<const std::uint8_t> bytes, Nanoseconds arrival, SampleSink& sink);

  /// The unit is started again (counters, times and what is known of the stations go on).
  void restart();

  /// Nothing comes any more: one sample in `state` (disconnected: the unit is gone; missing: it is there, but
  /// silent) for every station seen so far that is not in that state already.
  void fall_silent(ToolState state, Nanoseconds now, SampleSink& sink);

  StreamCounters counters() const;
  const StationFigures& station(int station) const {
    return stations_[static_cast<std::size_t>(station)].figures;
  }
  FrameClockFigures clock() const { return sequence_.clock().figures(); }

 private:
  struct Station {
    StationFigures figures;
    bool expected = false;         ///< it delivered, and was not declared missing since
    std::int64_t last_frame = -1;  ///< -1: the count began anew, a gap would mean nothing
    std::int64_t last_cycle = 0;   ///< number of the cycle it was last seen in
    Nanoseconds last_time = 0;
  };

  void on_reading(const LibertyReading& reading) override;
  void on_answer(const LibertyAnswer& answer) override;
  void begin_cycle(std::int64_t frame);
  void find_missing(std::uint32_t count);
  void begin_epoch();
  void report_silent(int station, ToolState state, std::uint32_t count, Nanoseconds arrival);
  bool count_losses(Station& station, std::int64_t frame);
  void emit(Station& station, PoseSample sample);
  ToolState state_of(const LibertyReading& reading) const;

  LibertyOptions options_;
  std::unique_ptr<LibertyParser> parser_;
  FrameSequence sequence_;
  std::array<Station, kMaxStations> stations_;
  StreamCounters counters_;
  std::int64_t cycle_frame_ = -1;
  std::int64_t cycle_ = 0;
  Nanoseconds cycle_time_ = 0;
  Nanoseconds arrival_ = 0;
  SampleSink* sink_ = nullptr;
};

}  // namespace linescope
