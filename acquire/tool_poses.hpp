// The poses of the three tools at the instant of a picture.
#pragma once

#include "acquire/acquire_options.hpp"
#include "acquire/tracker/pose_history.hpp"
#include "ipc/segment_types.hpp"

namespace linescope {

/// All three at one instant; `endoscope_answer` tells why a line cannot be placed when its pose is not ok.
struct ToolPoses {
  PoseAnswer endoscope_answer;
  LinePose<Endoscope> endoscope;
  LinePose<Object> object;
  LinePose<Harvester> harvester;
};

/// Looks the poses up (interpolated, never extrapolated). Called by the line's thread only.
class ToolPoseLookup {
 public:
  ToolPoseLookup(const PoseHistory& history, const StationRoles& roles, Nanoseconds longest_wait)
      : history_(history), roles_(roles), longest_wait_(longest_wait) {}

  /// True when waiting longer cannot improve the answer for `time`: every tool that ever delivered has a
  /// sample behind it, or the tracker is `longest_wait` past it.
  bool settled(Nanoseconds time) const;

  ToolPoses at(Nanoseconds time) const;

 private:
  bool behind(int station, Nanoseconds time, Nanoseconds newest) const;
  Nanoseconds newest() const;

  const PoseHistory& history_;
  StationRoles roles_;
  Nanoseconds longest_wait_;
};

}  // namespace linescope
