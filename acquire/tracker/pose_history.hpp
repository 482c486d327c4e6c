// The last seconds of every station's poses, and the pose at any instant between two of them.
//
// One thread adds, one other thread asks; neither waits for the other and nothing is allocated after
// construction.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string_view>

#include "acquire/tracker/sample_ring.hpp"
#include "common/pose_sample.hpp"
#include "common/result.hpp"

namespace linescope {

struct PoseHistoryOptions {
  int capacity = 2048;                          ///< samples kept per station (8.5 s at 240 Hz); 2 or more
  Nanoseconds longest_gap = 50 * kMillisecond;  ///< two neighbours further apart are not interpolated
  /// A picture's pose is the mean over this time about its instant (ToolPoseLookup); 0: the pose interpolated
  /// at that instant.
  Nanoseconds mean_over = 0;
};
Result<void> validate(const PoseHistoryOptions& options);

/// Why there is no pose at that instant.
enum class PoseMiss : std::uint8_t {
  none,          ///< there is one
  never_seen,    ///< the station has no sample at all
  too_early,     ///< older than the oldest sample kept
  too_late,      ///< newer than the newest sample: it may still come
  gap_too_long,  ///< the samples on both sides are further apart than longest_gap
  state_bad,     ///< a sample next to it is not good: see PoseAnswer::state
};
std::string_view name(PoseMiss miss);

struct PoseAnswer {
  PoseMiss miss = PoseMiss::never_seen;
  ToolState state = ToolState::never_seen;  ///< the worse of the two neighbours; ok when there is a pose
  Rigid<World, Sensor> world_from_sensor;   ///< meaningless unless ok()
  Nanoseconds gap = 0;                      ///< distance of the two neighbours, 0 for an exact hit
  bool ok() const { return miss == PoseMiss::none; }
};

/// The pose at `time`, not before `a` and not after `b`, two neighbouring samples of one station: slerp of
/// the rotation, straight line of the position. `a` and `b` may be the same sample.
PoseAnswer pose_between(const PoseSample& a, const PoseSample& b, Nanoseconds time, Nanoseconds longest_gap);

class PoseHistory {
 public:
  /// Precondition: validate(options) holds.
  explicit PoseHistory(const PoseHistoryOptions& options = {});

  /// Producer. False, and counted, when the sample is not newer than the station's last one or its station is
  /// unknown.
  bool add(const PoseSample& sample);

  /// Consumer. Slerp of the rotation, straight line of the position between the samples on both sides; a
  /// sample taken exactly at `time` is returned as it is. Never extrapolates.
  PoseAnswer pose_at(int station, Nanoseconds time) const;

  /// Consumer. The mean pose of the samples taken within [from, to], for a pose as blurred as the picture
  /// exposed over that window: a third of a single sample's noise at 240 Hz over a 30 Hz picture. Fails like
  /// pose_at when the window is not covered on both sides, has a gap or a bad sample; with no sample inside,
  /// the pose at its middle.
  PoseAnswer mean_pose(int station, Nanoseconds from, Nanoseconds to) const;

  /// Consumer. The newest sample of a station; false when there is none.
  bool latest(int station, PoseSample& out) const;

  const PoseHistoryOptions& options() const { return options_; }

  std::uint64_t rejected() const { return rejected_.load(std::memory_order_relaxed); }

 private:
  PoseHistoryOptions options_;
  std::array<std::unique_ptr<SampleRing>, kMaxStations> rings_;
  std::atomic<std::uint64_t> rejected_{0};
};

}  // namespace linescope
