// A tracker's running frame count mapped to CLOCK_MONOTONIC.
//
// Frames are taken at a fixed rhythm but arrive late by a varying amount: the host was busy, the bus was,
// records came in bunches. Lateness is one-sided, so the fit is made to the least late arrival of every tenth
// of a second, over the last ten seconds, with weights that take out what a stall leaves behind (Tukey's
// biweight on the spread of the residuals). What remains is the crystal's rate and the shortest way through
// the bus.
#pragma once

#include <array>
#include <cstdint>

#include "common/result.hpp"
#include "common/time.hpp"

namespace linescope {

struct FrameClockOptions {
  double nominal_hz = 240;  ///< frames per second the device is set to
  Nanoseconds latency =
      3'500 * kMicrosecond;  ///< from the middle of the measurement to the earliest possible arrival
};
Result<void> validate(const FrameClockOptions& options);

struct FrameClockFigures {
  double rate_hz = 0;  ///< fitted; nominal during the first two seconds
  Nanoseconds fit_residual =
      0;  ///< spread (robust sigma) of the least late arrivals about the line: error of the mapping
  Nanoseconds typical_lateness = 0;  ///< median over the window of the mean lateness of a tenth of a second
  Nanoseconds worst_lateness = 0;    ///< largest lateness in the window: the longest stall
  int blocks = 0;                    ///< tenths of a second the fit rests on
};

/// Not thread-safe; allocates nothing.
class FrameClock {
 public:
  /// Precondition: validate(options) holds.
  explicit FrameClock(const FrameClockOptions& options = {});

  /// A frame arrived. Frames in rising order; gaps are fine.
  void observe(std::int64_t frame, Nanoseconds arrival);

  /// True once a frame was observed.
  bool running() const { return running_; }
  /// When a frame arrives that is not held up. Precondition: running().
  Nanoseconds arrival_of(std::int64_t frame) const;
  /// When it was measured: the same less the latency.
  Nanoseconds time_of(std::int64_t frame) const { return arrival_of(frame) - options_.latency; }

  FrameClockFigures figures() const;
  void reset();

 private:
  static constexpr int kBlocks = 100;
  static constexpr int kBlocksForRate = 20;

  /// A tenth of a second; lateness relative to the nominal rhythm from the first frame on, ns.
  struct Block {
    double frame = 0;  ///< of the least late arrival, relative to the first frame
    double least = 0;
    double sum = 0;
    double most = 0;
    int count = 0;
  };

  void close_block();
  void refit();
  void fit_offset();
  void fit_line();
  double line(double frame) const { return offset_ + slope_ * frame; }
  double residual(const Block& block) const { return block.least - line(block.frame); }

  FrameClockOptions options_;
  double period_;
  std::int64_t block_frames_;
  bool running_ = false;
  std::int64_t first_frame_ = 0;
  Nanoseconds first_arrival_ = 0;
  std::int64_t block_number_ = 0;
  Block current_;
  std::array<Block, kBlocks> blocks_;
  int used_ = 0;
  int next_ = 0;
  double offset_ = 0;  ///< lateness of the line at the first frame, ns
  double slope_ = 0;   ///< ns per frame beyond the nominal period
  double sigma_ = 0;
};

}  // namespace linescope
