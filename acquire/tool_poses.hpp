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

/// Looks the poses up: interpolated, never extrapolated, and, where PoseHistoryOptions::mean_over asks for
/// it, averaged over seven instants spread evenly over that time about the picture's own: a noisy tracker
/// shakes a line less then, a hand that turns back within so short a time is smoothed. Called by the line's
/// thread only.
class ToolPoseLookup {
 public:
  ToolPoseLookup(const PoseHistory& history, const StationRoles& roles, Nanoseconds longest_wait)
      : history_(history),
        roles_(roles),
        longest_wait_(longest_wait),
        step_(history.options().mean_over / 6) {}

  /// True when waiting longer cannot improve the answer for `time`: every tool that ever delivered has a
  /// sample behind the last instant averaged, or the tracker is `longest_wait` past it.
  bool settled(Nanoseconds time) const;

  /// Where not all instants have a pose on both sides of `time`, the mean is taken over the nearer ones that
  /// have; the state is that of the instant itself.
  ToolPoses at(Nanoseconds time) const;

 private:
  PoseAnswer mean_about(int station, Nanoseconds time) const;
  bool behind(int station, Nanoseconds time, Nanoseconds newest) const;
  Nanoseconds newest() const;

  const PoseHistory& history_;
  StationRoles roles_;
  Nanoseconds longest_wait_;
  Nanoseconds step_;  ///< between the instants averaged
};

}  // namespace linescope
