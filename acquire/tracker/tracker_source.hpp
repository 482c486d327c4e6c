// One interface for every tracker: a real LIBERTY, recorded poses, the twin.
#pragma once

#include <cstdint>
#include <string>

#include "acquire/pull.hpp"
#include "common/pose_sample.hpp"
#include "common/result.hpp"

namespace linescope {

/// What is known of one station (sensor) right now.
struct StationStatus {
  ToolState state = ToolState::never_seen;
  std::string reason;  ///< why it is not ok, in words for the operator; may carry a remark when it is
  Nanoseconds last_sample = 0;  ///< acquisition time of the newest sample of this station
  std::uint64_t samples = 0;    ///< samples handed out, whatever their state
  std::uint64_t lost = 0;       ///< samples the tracker took but we never got, by its frame count
};

/// Everything that arrived, and everything that was dropped, by reason. Counters never go back.
struct TrackerCounters {
  std::uint64_t samples = 0;  ///< handed out, all stations
  std::uint64_t lost = 0;     ///< missing by frame count, all stations
  std::uint64_t bad_records =
      0;  ///< framed like a record, refused for its content (NaN, quaternion, length, text)
  std::uint64_t resyncs = 0;          ///< times the byte stream lost its rhythm and found it again
  std::uint64_t skipped_bytes = 0;    ///< bytes stepped over while doing so
  std::uint64_t out_of_order = 0;     ///< records that came twice or with an earlier frame count
  std::uint64_t device_errors = 0;    ///< records and answers that carried an error code
  std::uint64_t missing_poses = 0;    ///< recorded source: pictures without a pose
  std::uint64_t queue_overruns = 0;   ///< samples dropped because next() was not called in time
  std::uint64_t transfer_faults = 0;  ///< stalls, overflows and the like below the byte stream
  std::uint64_t reconnects = 0;       ///< times the device was started again after the first time
};

/// The device as a whole, in numbers.
struct TrackerFigures {
  bool delivering = false;         ///< samples are coming or may come at any moment
  double rate_hz = 0;              ///< measured cycles per second; 0 while unknown or meaningless
  Nanoseconds clock_residual = 0;  ///< typical distance of an arrival from the clock fit; 0 while unknown
};

struct TrackerStatus : TrackerFigures {
  std::string sentence;  ///< what it does, or why it does not deliver and what to do about it
};

/// Threads: all calls from one thread, except status(), figures(), station() and counters(), which any thread
/// may call at any time after construction.
///
/// A live source (live() == true) delivers as things happen and next() waits at most 50 ms. A stepped source
/// hands out its samples in time order, at once, and never sleeps: the caller paces it.
class TrackerSource {
 public:
  virtual ~TrackerSource() = default;

  /// Opens and checks. A failure is final for this object: nothing was started.
  virtual Result<void> start() = 0;

  /// The next sample of any station, times of one station strictly increasing. A sample whose state is not
  /// usable() reports a change of that station (unplugged, out of range ...) and carries no pose. An error
  /// concerns the input itself, and what was handed out before stays good: with code `unreadable` it is one
  /// row of a file, and the next call goes on behind it; with any other code the source has come to its end.
  virtual Result<Pull> next(PoseSample& out) = 0;

  virtual bool live() const = 0;
  virtual std::string description() const = 0;
  /// Samples per second and station that the device is set to; 0: unknown. After start().
  virtual double nominal_hz() const { return 0; }

  virtual TrackerStatus status() const = 0;
  /// The same without its text. A live source allocates nothing here.
  virtual TrackerFigures figures() const { return status(); }
  /// `station` 0 .. kMaxStations-1.
  virtual StationStatus station(int station) const = 0;
  virtual TrackerCounters counters() const = 0;
};

}  // namespace linescope
