// Everything that works together while the daemon runs, and the two ways to drive it.
#pragma once

#include <atomic>
#include <memory>

#include "acquire/acquire_options.hpp"
#include "acquire/command_desk.hpp"
#include "acquire/laser_watch.hpp"
#include "acquire/line_pipeline.hpp"
#include "acquire/pose_intake.hpp"
#include "acquire/record/recorder.hpp"
#include "acquire/sources.hpp"
#include "acquire/state_report.hpp"
#include "acquire/tool_poses.hpp"

namespace linescope {

/// Plain aggregate: the drivers below use its parts.
class Acquisition {
 public:
  /// `sources` started; `writer` and `stop` must outlive this.
  static Result<std::unique_ptr<Acquisition>> create(const AcquireOptions& options, Sources sources,
                                                     SegmentWriter& writer, std::atomic<bool>& stop);

  /// From here on every picture and sample goes to `recorder`, too. Before the run starts.
  void record_to(std::unique_ptr<Recorder> recorder);

  const RunOptions run;
  const Nanoseconds longest_wait;
  Sources sources;
  std::atomic<bool>& stop;
  PoseHistory history;
  ToolPoseLookup poses;
  ScanControl scan;
  LaserWatch laser;
  CommandDesk desk;
  StateReport state;
  LinePipeline pipeline;
  std::unique_ptr<PoseIntake> intake;  ///< null without a tracker
  std::unique_ptr<Recorder> recorder;  ///< null: nothing is recorded

 private:
  Acquisition(const AcquireOptions& options, Sources given, LineReconstructor reconstructor,
              SegmentWriter& writer, std::atomic<bool>& stop_flag);
};

/// Recorded and simulated sources, one thread: pictures and samples in the order of their time stamps, at
/// their own speed or as fast as possible. The same input gives the same lines. Returns when stopped, or at
/// the end with exit_at_end.
void run_stepped(Acquisition& acquisition);

/// Devices: a thread for the tracker, and the calling thread for the camera. Returns when stopped.
void run_live(Acquisition& acquisition);

}  // namespace linescope
