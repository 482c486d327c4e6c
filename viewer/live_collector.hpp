// Copies what a segment says of its writer, tools, camera, calibration and figures into a LiveView.
// Belongs to the acquisition thread.
#pragma once

#include "ipc/segment_reader.hpp"
#include "viewer/view_state.hpp"

namespace linescope {

class LiveCollector {
 public:
  /// Everything but the scan. False: the segment holds impossible numbers, detach.
  bool collect(const SegmentReader& reader, Nanoseconds now, LiveView& view);

  /// The harvester, camera and object of a daemon that is not there any more are not either.
  static void mark_disconnected(LiveView& view, const std::string& why);

  /// Calibration of this segment, once it was read well.
  const std::optional<Calibration>& calibration() const { return calibration_; }

  /// Before another segment.
  void reset();

 private:
  void collect_daemon(const SegmentReader& reader, LiveView& view);
  bool collect_tools(const SegmentReader& reader, Nanoseconds now, LiveView& view);
  void collect_tool(const SegmentReader& reader, int station, Nanoseconds now, ToolView& tool,
                    const SensorStatus& status);
  void collect_camera(const SegmentReader& reader, Nanoseconds now, LiveView& view);
  void collect_picture(const SegmentReader& reader, LiveView& view);
  void collect_calibration(const SegmentReader& reader, LiveView& view);
  void collect_diagnostics(const SegmentReader& reader, Nanoseconds now, LiveView& view);

  Picture picture_;  ///< buffers reused
  std::string calibration_text_;
  std::optional<Calibration> calibration_;
  Nanoseconds next_figures_ = 0;
};

}  // namespace linescope
