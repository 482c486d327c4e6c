// From the tracker to the history and the segment: poses, the state of every sensor, and what was lost on the
// way.
#pragma once

#include <array>

#include "acquire/acquire_options.hpp"
#include "acquire/tracker/pose_history.hpp"
#include "acquire/tracker/tracker_source.hpp"
#include "ipc/segment_writer.hpp"

namespace linescope {

/// Belongs to the tracker's thread.
class PoseIntake {
 public:
  /// All references must outlive the intake.
  PoseIntake(const TrackerSource& tracker, const StationRoles& roles, PoseHistory& history,
             SegmentWriter& writer);

  /// A sample that is due now.
  void take(const PoseSample& sample);

  /// A complaint of the source about its input.
  void note(const Error& error);

  /// Publishes every sensor's state and what was lost, at most every 100 ms; call it often. A state that
  /// changes with a sample is published with it.
  void report(Nanoseconds now);

 private:
  void admit(const PoseSample& sample);
  void report_station(int station, Nanoseconds now);
  void count_losses();
  void report_device();

  const TrackerSource& tracker_;
  StationRoles roles_;
  PoseHistory& history_;
  SegmentWriter& writer_;
  std::array<Nanoseconds, kMaxStations> last_good_{};
  std::array<ToolState, kMaxStations> reported_{};
  std::string complaint_;
  std::string said_;       ///< the tracker's last sentence in the log
  SensorStatus outgoing_;  ///< its texts keep their memory
  TrackerCounters counted_;
  Nanoseconds last_report_ = 0;
};

}  // namespace linescope
