#include <fmt/format.h>

#include "tools/inspect/snapshot.hpp"

namespace linescope {
namespace {

using Out = std::back_insert_iterator<std::string>;

std::string age(Nanoseconds time, Nanoseconds now) {
  if (time == 0) return "never";
  return fmt::format("{:.1f} s ago", seconds_from(now - time));
}

void identity(const SegmentSnapshot& s, Out out) {
  const SegmentIdentity& id = s.identity;
  fmt::format_to(out, "segment   {} ({:.1f} MiB, layout {}.{}), {}\n", id.name,
                 static_cast<double>(id.bytes) / (1 << 20), id.layout_major, id.layout_minor, id.program);
  fmt::format_to(out, "writer    pid {}, uid {}, session {:016x}, up {:.1f} s\n", id.writer_pid,
                 id.writer_uid, id.session_id, seconds_from(s.taken - id.started));
  fmt::format_to(out, "life      {}, last heartbeat {:.0f} ms ago{}{}\n", name(s.life.life),
                 milliseconds_from(s.life.silent_for), s.life.text.empty() ? "" : ": ", s.life.text);
  fmt::format_to(out, "state     {} for {:.1f} s{}{}\n", name(s.daemon.state),
                 seconds_from(s.taken - s.daemon.since), s.daemon.reason.empty() ? "" : ": ",
                 s.daemon.reason);
  fmt::format_to(out, "scan      {}, {}: {} lines of {}, {} points of {}{}\n", s.scan_id,
                 s.scanning ? "scanning" : "paused", s.lines, id.line_capacity, s.points, id.point_capacity,
                 s.full ? ", FULL" : "");
}

void rate(const RateFigures& r, float nominal_hz, Out out) {
  if (r.hz > 0) fmt::format_to(out, ", {:.1f} Hz", r.hz);
  if (nominal_hz > 0) fmt::format_to(out, " (nominal {:g} Hz)", nominal_hz);
  if (r.hz > 0) {
    fmt::format_to(out, ", period {:.2f} ms, spread {:.2f} ms, longest {:.1f} ms", r.period_mean_ms,
                   r.period_sd_ms, r.period_max_ms);
  }
}

void camera(const SegmentSnapshot& s, Out out) {
  fmt::format_to(out, "camera    ");
  if (s.has_camera) {
    fmt::format_to(out, "{}, {}, {} x {}, {} pictures, last good {}", s.camera.name, name(s.camera.state),
                   s.camera.width, s.camera.height, s.camera.frames, age(s.camera.last_good, s.taken));
  } else {
    fmt::format_to(out, "no statement");
  }
  rate(s.frame_rate, s.has_camera ? s.camera.nominal_hz : 0, out);
  if (!s.camera.reason.empty()) fmt::format_to(out, ": {}", s.camera.reason);
  fmt::format_to(out, "\n");
}

void sensor(const SensorSnapshot& x, Nanoseconds now, Out out) {
  fmt::format_to(out, "sensor {}  ", x.station + 1);
  if (x.has_status)
    fmt::format_to(out, "{} ({}), {}, lost {}", x.status.name, name(x.status.role), name(x.status.state),
                   x.status.lost);
  if (x.has_pose) {
    const Eigen::Vector3d& p = x.pose.world_from_sensor.translation();
    const ToolState state = aged(x.pose.state, x.pose.time, now);
    fmt::format_to(out, "{}pose {}", x.has_status ? ", " : "", name(state));
    if (usable(state)) fmt::format_to(out, " at ({:.1f}, {:.1f}, {:.1f}) mm", p.x(), p.y(), p.z());
    fmt::format_to(out, ", {}", age(x.pose.time, now));
  }
  rate(x.rate, x.has_status ? x.status.nominal_hz : 0, out);
  if (!x.status.reason.empty()) fmt::format_to(out, ": {}", x.status.reason);
  fmt::format_to(out, "\n");
}

void counters(const SegmentSnapshot& s, bool all, Out out) {
  for (const CounterValue& c : s.counters) {
    if (all || c.value > 0) fmt::format_to(out, "count     {:<34} {:>12}\n", c.name, c.value);
  }
}

void latencies(const SegmentSnapshot& s, bool all, Out out) {
  for (const LatencyFigures& l : s.latencies) {
    if (!all && l.count == 0) continue;
    fmt::format_to(
        out, "time      {:<16} p50 {:>9.3f} ms  p95 {:>9.3f} ms  p99 {:>9.3f} ms  max {:>9.3f} ms  of {}\n",
        l.name, milliseconds_from(l.p50), milliseconds_from(l.p95), milliseconds_from(l.p99),
        milliseconds_from(l.max), l.count);
  }
}

}  // namespace

std::string as_text(const SegmentSnapshot& s, bool all_counters) {
  std::string text;
  const Out out(text);
  identity(s, out);
  camera(s, out);
  for (const SensorSnapshot& x : s.sensors) sensor(x, s.taken, out);
  counters(s, all_counters, out);
  latencies(s, all_counters, out);
  return text;
}

}  // namespace linescope
