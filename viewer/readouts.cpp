#include "viewer/readouts.hpp"

#include <fmt/format.h>

#include <cmath>

#include "common/units.hpp"

namespace linescope {
namespace {

constexpr Nanoseconds kLineIsNewFor = 500 * kMillisecond;

bool link_good(const LiveView& live, Nanoseconds now) {
  return live.link.state == LinkState::attached && now - live.time <= kBlankAfter;
}

std::string tool_reason(const LiveView& live, ToolRole role, Nanoseconds now) {
  const StatusLine line = tool_status(live, role, now);
  return line.detail.empty() ? fmt::format("{} {}", line.title, line.word)
                             : fmt::format("{} {}: {}", line.title, line.word, line.detail);
}

bool tool_good(const LiveView& live, ToolRole role, Nanoseconds now) {
  const ToolView& tool = live.tool(role);
  return usable(tool.state) && now - tool.acquired <= kBlankAfter;
}

/// The worst link of the chain from the tracker to the angle, or nothing.
std::string broken_link(const ViewState& state, Nanoseconds now) {
  const LiveView& live = *state.live;
  if (!link_good(live, now)) return daemon_status(live, now).detail;
  if (!tool_good(live, ToolRole::harvester, now)) return tool_reason(live, ToolRole::harvester, now);
  if (live.held_in == HeldIn::object && !tool_good(live, ToolRole::object, now))
    return tool_reason(live, ToolRole::object, now);
  if (!live.calibration_known) return "no calibration of the harvester";
  const NavigationView& navigation = *state.navigation;
  const Nanoseconds oldest = std::min(navigation.harvester_time, navigation.object_time);
  if (!navigation.asked || now - oldest > kBlankAfter) return "navigation has no recent pose";
  return navigation.good ? std::string() : navigation.reason;
}

Readout number(const std::string& text) {
  return {.text = text, .reason = {}};
}
Readout blank(const std::string& reason) {
  return {.text = kBlank, .reason = reason};
}

Readout interval_readout(const NavigationView& n) {
  if (!std::isfinite(n.angle_low) || !std::isfinite(n.angle_high))
    return blank("this method gives no interval");
  return number(
      fmt::format("{:.1f} – {:.1f}°", degrees_from_radians(n.angle_low), degrees_from_radians(n.angle_high)));
}

Readout millimetres(std::optional<double> value, const char* missing) {
  if (!value) return blank(missing);
  return number(fmt::format("{:.1f} mm", *value));
}

NormalEstimate estimate_of(const NavigationView& n) {
  NormalEstimate estimate;
  estimate.reason = NormalReason::none;
  estimate.angle = n.angle;
  estimate.distance = n.distance;
  estimate.depth = n.depth;
  return estimate;
}

Mood mood_of(ToolState state) {
  switch (state) {
    case ToolState::ok:
      return Mood::good;
    case ToolState::distorted_field:
    case ToolState::out_of_view:
      return Mood::caution;
    case ToolState::never_seen:
      return Mood::off;
    case ToolState::stale:
    case ToolState::missing:
    case ToolState::disconnected:
      break;
  }
  return Mood::bad;
}

std::string joined(const std::string& reason, const std::string& age) {
  if (age.empty()) return reason;
  if (reason.empty()) return fmt::format("last good {} ago", age);
  return fmt::format("{} · last good {} ago", reason, age);
}

const char* title(ToolRole role) {
  switch (role) {
    case ToolRole::endoscope:
      return "Endoscope";
    case ToolRole::object:
      return "Object";
    case ToolRole::harvester:
      return "Harvester";
  }
  return "?";
}

Banner link_banner(const LiveView& live) {
  const std::string start = "Start linescope-acquire; the viewer attaches by itself.";
  switch (live.link.state) {
    case LinkState::file:
      return {Mood::off, live.link.text, "Nothing is live. L goes back to the daemon."};
    case LinkState::searching:
      return {Mood::caution, fmt::format("No daemon on segment \"{}\"", live.link.segment), start};
    case LinkState::silent:
      return {Mood::bad, fmt::format("The daemon (pid {}) does not answer any more", live.link.pid),
              "The surface is kept. Restart linescope-acquire; the viewer goes on by itself."};
    case LinkState::ended:
      return {Mood::bad, fmt::format("The daemon (pid {}) has ended", live.link.pid),
              "The surface is kept. " + start};
    case LinkState::refused:
      return {Mood::bad, "The segment cannot be used: " + live.link.text,
              "Restart linescope-acquire of this version."};
    case LinkState::attached:
      break;
  }
  return {};
}

Banner daemon_banner(const LiveView& live) {
  if (live.scan.full)
    return {Mood::caution, "The segment is full: further lines are not stored",
            "Poses and picture go on. Save the session, then Clear; or start the daemon with more capacity."};
  if (live.daemon.known && live.daemon.trouble)
    return {Mood::bad,
            fmt::format("Daemon: {}{}{}", live.daemon.state, live.daemon.reason.empty() ? "" : ": ",
                        live.daemon.reason),
            "It goes on by itself when the device is back. Check cable and power."};
  if (!live.calibration_trouble.empty())
    return {Mood::bad, live.calibration_trouble,
            "No navigation without it: give the daemon a valid calibration file."};
  return {};
}

/// All tools that ever delivered are late, and there are at least two of them: no cable of one sensor does
/// that.
bool all_stale(const LiveView& live, Nanoseconds now) {
  int seen = 0;
  for (const ToolView& tool : live.tools) {
    if (tool.acquired == 0) continue;
    if (now - tool.acquired <= kBlankAfter) return false;
    ++seen;
  }
  return seen > 1;
}

Banner tool_banner(const LiveView& live, Nanoseconds now) {
  if (live.held_in == HeldIn::object && live.scan.lines_unplaced > 0 &&
      !tool_good(live, ToolRole::object, now))
    return {Mood::caution,
            fmt::format("{} lines are not drawn: object sensor {}", grouped(live.scan.lines_unplaced),
                        name(live.scan.unplaced_because)),
            "Fix sensor 2 to the object; or, where nothing moves, start the viewer with --hold-in world."};
  if (all_stale(live, now))
    return {Mood::bad, "No fresh pose of any tool",
            "Check the tracker; if it is well, the daemon's machine is overloaded: close other programs."};
  for (const ToolRole role : {ToolRole::object, ToolRole::harvester, ToolRole::endoscope}) {
    const StatusLine line = tool_status(live, role, now);
    if (line.mood == Mood::bad)
      return {Mood::bad, fmt::format("{}: {}", line.title, line.word),
              "Check the sensor's cable and its place; what depends on it is blank."};
  }
  return {};
}

}  // namespace

std::string grouped(std::uint64_t number) {
  std::string digits = std::to_string(number);
  for (std::ptrdiff_t at = static_cast<std::ptrdiff_t>(digits.size()) - 3; at > 0; at -= 3)
    digits.insert(static_cast<std::size_t>(at), ",");
  return digits;
}

std::string age_text(Nanoseconds since, Nanoseconds now) {
  if (since == 0) return {};
  const double seconds = std::max(0.0, seconds_from(now - since));
  if (seconds < 100) return fmt::format("{:.1f} s", seconds);
  if (seconds < 5400) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

GuidanceOptions guidance_options(const Tolerance& tolerance) {
  GuidanceOptions options;
  options.angle_tolerance = radians_from_degrees(tolerance.angle_deg);
  options.distance_tolerance = tolerance.distance_mm;
  return options;
}

AngleReadout angle_readout(const ViewState& state, Nanoseconds now, Guidance& guidance) {
  AngleReadout out;
  const std::string why = broken_link(state, now);
  if (!why.empty()) {
    guidance.blank(now);
    out.angle = out.interval = out.distance = out.depth = blank(why);
    return out;
  }
  const NavigationView& n = *state.navigation;
  out.pose_time = std::min(n.harvester_time, n.object_time);
  const GuidanceState& guided = guidance.update(estimate_of(n), now);
  if (!guided.angle) {
    out.angle = out.interval = out.distance = out.depth = blank("the angle is not a number");
    return out;
  }
  out.angle = number(fmt::format("{:.1f}°", degrees_from_radians(*guided.angle)));
  out.interval = interval_readout(n);
  out.distance = millimetres(guided.distance, "no surface point near the tip");
  out.depth = millimetres(guided.depth, "the axis does not meet the surface");
  out.in_tolerance = guided.within;
  out.held = guided.held;
  out.held_share = guided.held_share;
  return out;
}

StatusLine tool_status(const LiveView& live, ToolRole role, Nanoseconds now) {
  const ToolView& tool = live.tool(role);
  StatusLine line{.title = title(role), .word = {}, .detail = {}, .mood = Mood::off};
  ToolState state = tool.state;
  if (usable(state) && now - tool.acquired > kBlankAfter) state = ToolState::stale;
  line.word = std::string(name(state));
  line.mood = mood_of(state);
  if (state == ToolState::ok) {
    if (tool.rate_hz > 0) line.detail = fmt::format("{:.0f} Hz", tool.rate_hz);
    return line;
  }
  line.detail = joined(tool.reason, age_text(tool.acquired, now));
  return line;
}

StatusLine camera_status(const LiveView& live, Nanoseconds now) {
  const CameraView& camera = live.camera;
  // A camera that delivers, but pictures of long ago, is not a live camera.
  const bool late = live.picture && now - live.picture->time > kPictureIsLiveFor;
  const ToolState state = usable(camera.state) && late ? ToolState::stale : camera.state;
  StatusLine line{.title = "Camera", .word = std::string(name(state)), .detail = {}, .mood = mood_of(state)};
  if (state == ToolState::stale && usable(camera.state)) {
    line.detail = fmt::format("newest picture is {} old", age_text(live.picture->time, now));
    return line;
  }
  if (camera.state == ToolState::ok) {
    line.detail = camera.rate_hz > 0 ? fmt::format("{:.0f} Hz", camera.rate_hz) : camera.name;
    // The daemon's words on the laser's light: "line quality 0.83, 2 % burnt out; lower the laser: ...". What
    // is to be done comes first, the card is narrow.
    const std::size_t hint = camera.reason.find("; ");
    if (hint != std::string::npos)
      return {line.title, "check laser", camera.reason.substr(hint + 2), Mood::caution};
    const std::string quality = camera.reason.substr(0, camera.reason.find(','));
    if (!quality.empty()) line.detail += " · " + quality;
    return line;
  }
  line.detail = joined(camera.reason, age_text(camera.last_picture, now));
  return line;
}

StatusLine daemon_status(const LiveView& live, Nanoseconds now) {
  StatusLine line{.title = "Daemon", .word = {}, .detail = live.link.text, .mood = Mood::bad};
  switch (live.link.state) {
    case LinkState::attached:
      line.word = live.daemon.known ? live.daemon.state : "attached";
      line.mood = live.daemon.trouble || live.scan.full ? Mood::caution : Mood::good;
      line.detail = live.daemon.reason.empty() ? fmt::format("pid {}", live.link.pid) : live.daemon.reason;
      if (now - live.time > kBlankAfter) return {line.title, "unknown", "the viewer gets no data", Mood::bad};
      return line;
    case LinkState::file:
      return {line.title, "not asked", "a file is shown", Mood::off};
    case LinkState::searching:
      line.word = "not found", line.mood = Mood::off;
      break;
    case LinkState::silent:
      line.word = "silent";
      break;
    case LinkState::ended:
      line.word = "ended";
      break;
    case LinkState::refused:
      line.word = "unusable";
      break;
  }
  if (const std::string age = age_text(live.link.heartbeat, now); !age.empty())
    line.detail += fmt::format(" · last sign of life {} ago", age);
  return line;
}

Banner banner(const LiveView& live, Nanoseconds now) {
  if (Banner b = link_banner(live); !b.text.empty()) return b;
  if (Banner b = daemon_banner(live); !b.text.empty()) return b;
  return tool_banner(live, now);
}

Readout gap_readout(const LiveView& live, Nanoseconds now) {
  if (!link_good(live, now)) return blank("no daemon");
  const LineView& line = live.scan.newest;
  if (line.time == 0 || line.gap <= 0) return blank("no line yet");
  if (now - line.time > kLineIsNewFor)
    return blank(fmt::format("last line {} ago", age_text(line.time, now)));
  return number(fmt::format("{:.1f} mm", line.gap));
}

Readout line_quality_readout(const LiveView& live, Nanoseconds now) {
  const Readout gap = gap_readout(live, now);
  if (gap.blank()) return gap;
  const LineView& line = live.scan.newest;
  return number(fmt::format("{} points · {:.0f} % of width · SNR {:.0f}", line.points,
                            100.0 * static_cast<double>(line.coverage), static_cast<double>(line.snr)));
}

std::string scan_summary(const LiveView& live) {
  std::string text =
      fmt::format("{} points in {} lines", grouped(live.scan.points), grouped(live.scan.lines));
  if (live.scan.lines_unplaced > 0)
    text += fmt::format(" · {} lines not drawn (object {})", grouped(live.scan.lines_unplaced),
                        name(live.scan.unplaced_because));
  if (live.scan.lines_missed > 0) text += fmt::format(" · {} lines missed", grouped(live.scan.lines_missed));
  return text;
}

}  // namespace linescope
