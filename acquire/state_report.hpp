// What the daemon says of itself and of its camera. Belongs to the line's thread.
#pragma once

#include <string>
#include <vector>

#include "acquire/camera/camera_source.hpp"
#include "acquire/laser_watch.hpp"
#include "acquire/record/recorder.hpp"
#include "acquire/tracker/tracker_source.hpp"
#include "ipc/segment_writer.hpp"

namespace linescope {

class StateReport {
 public:
  /// `tracker` may be null. All references must outlive the report.
  StateReport(const CameraSource& camera, const TrackerSource* tracker, SegmentWriter& writer);

  /// What the recorder loses is counted and said, and every change of state becomes an event of the
  /// recording; null: nothing is recorded.
  void watch(Recorder* recorder) { recorder_ = recorder; }

  /// The light of the line is said with the camera's state.
  void watch(LaserWatch* laser) { laser_ = laser; }

  /// A picture that could not be used.
  void note(const Error& error);

  /// Publishes what changed, and the camera's state at least every 100 ms; call it often.
  void update(Nanoseconds now);

  /// A good picture arrived.
  void frame(const Frame& frame);

 private:
  void report_camera(const CameraStatus& status, Nanoseconds now);
  void report_daemon(const CameraStatus& status, Nanoseconds now);
  void log_remarks(const CameraStatus& status);
  void count_losses(const CameraCounters& now);
  void count_recording(const RecorderStatus& status);

  const CameraSource& camera_;
  const TrackerSource* tracker_;
  SegmentWriter& writer_;
  CameraReport report_;
  CameraCounters counted_;
  Recorder* recorder_ = nullptr;
  LaserWatch* laser_ = nullptr;
  std::vector<std::string> remarks_;
  std::uint64_t recording_lost_ = 0;
  std::string complaint_;  ///< about the last picture that could not be used
  Nanoseconds complaint_at_ = 0;
  DaemonState state_ = DaemonState::starting;
  std::string reason_;
  Nanoseconds last_report_ = 0;
};

}  // namespace linescope
