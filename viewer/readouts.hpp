// What the screen says, as text: the one place that decides whether a number may be shown. Pure functions of
// the state and of the time at which it is shown, so that a number goes blank even when every other thread
// hangs.
#pragma once

#include <string>
#include <vector>

#include "viewer/navigate/guidance.hpp"
#include "viewer/view_state.hpp"

namespace linescope {

/// What rests on poses older than this is blank. A little less than kStaleAfter, because the screen changes
/// only with the next display tick and 0.2 s is what the operator was promised.
inline constexpr Nanoseconds kBlankAfter = kStaleAfter - 50 * kMillisecond;

/// A picture older than this is not live.
inline constexpr Nanoseconds kPictureIsLiveFor = 500 * kMillisecond;

/// Shown instead of a number without a good input.
inline constexpr const char* kBlank = "--";

/// How good or bad a statement is; told by colour, sign and word, never by colour alone.
enum class Mood : std::uint8_t { good, caution, bad, off };

/// A number with its unit, or kBlank with the reason and the age of the last good input.
struct Readout {
  std::string text = kBlank;
  std::string reason;  ///< empty when there is a number
  bool blank() const { return text == kBlank; }
};

struct AngleReadout {
  Readout angle;              ///< "12.3°"
  Readout interval;           ///< "95 %: 11.0 – 13.9°"
  Readout distance;           ///< "1.2 mm"
  Readout depth;              ///< along the harvester's axis
  Nanoseconds pose_time = 0;  ///< of the oldest pose the angle rests on
  bool in_tolerance = false;
  bool held = false;      ///< within tolerance for the whole hold time
  double held_share = 0;  ///< 0..1 of the hold time
};

/// The limits within which the harvester counts as on target.
struct Tolerance {
  double angle_deg = 3;
  double distance_mm = 1;
  bool operator==(const Tolerance&) const = default;
};

/// The rest (hold time, slack, dead-band of the shown numbers) is the guidance's.
GuidanceOptions guidance_options(const Tolerance& tolerance);

/// AngDif and what belongs to it. `guidance` is told what is shown, and keeps it from flickering.
AngleReadout angle_readout(const ViewState& state, Nanoseconds now, Guidance& guidance);

/// State of a tool at `now`, aged, with the link's state on top.
struct StatusLine {
  std::string title;   ///< "Harvester"
  std::string word;    ///< "ok", "stale", ...
  std::string detail;  ///< reason and age
  Mood mood = Mood::off;
};
StatusLine tool_status(const LiveView& live, ToolRole role, Nanoseconds now);
StatusLine camera_status(const LiveView& live, Nanoseconds now);
StatusLine daemon_status(const LiveView& live, Nanoseconds now);

/// The most important thing that is wrong and what to do about it; mood good and empty text when nothing is.
struct Banner {
  Mood mood = Mood::good;
  std::string text;
  std::string advice;
};
Banner banner(const LiveView& live, Nanoseconds now);

/// Distance camera to surface of the newest line; the thesis's range of use is 10-20 mm.
inline constexpr double kGapFrom = 10, kGapTo = 20;  ///< mm
Readout gap_readout(const LiveView& live, Nanoseconds now);
Readout line_quality_readout(const LiveView& live, Nanoseconds now);

/// "12,345 points in 67 lines", with what was not drawn and why.
std::string scan_summary(const LiveView& live);

/// "0.4 s", "3 min"; empty for never.
std::string age_text(Nanoseconds since, Nanoseconds now);
/// 12345678 -> "12,345,678"
std::string grouped(std::uint64_t number);

}  // namespace linescope
