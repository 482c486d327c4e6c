#include "tools/inspect/json_writer.hpp"
#include "tools/inspect/snapshot.hpp"

namespace linescope {
namespace {

void identity(const SegmentIdentity& id, JsonWriter& json) {
  json.begin_object("identity");
  json.add("name", id.name);
  json.add("program", id.program);
  json.add("session", fmt::format("{:016x}", id.session_id));
  json.add("pid", id.writer_pid);
  json.add("uid", id.writer_uid);
  json.add("layout", fmt::format("{}.{}", id.layout_major, id.layout_minor));
  json.add("bytes", id.bytes);
  json.add("started_ns", id.started);
  json.add("started_utc_ns", id.started_utc);
  json.add("line_capacity", id.line_capacity);
  json.add("point_capacity", id.point_capacity);
  json.add("pose_history", id.pose_history);
  json.end_object();
}

void state(const SegmentSnapshot& s, JsonWriter& json) {
  json.add("life", name(s.life.life));
  json.add("silent_ms", milliseconds_from(s.life.silent_for));
  json.add("life_text", s.life.text);
  json.add("state", name(s.daemon.state));
  json.add("state_since_ns", s.daemon.since);
  json.add("state_reason", s.daemon.reason);
  json.begin_object("scan");
  json.add("id", s.scan_id);
  json.add("scanning", s.scanning);
  json.add("full", s.full);
  json.add("lines", s.lines);
  json.add("points", s.points);
  json.end_object();
}

void rate(const RateFigures& r, float nominal_hz, JsonWriter& json) {
  json.begin_object("rate");
  if (nominal_hz > 0) json.add("nominal_hz", nominal_hz);
  json.add("samples", r.samples);
  json.add("hz", r.hz);
  json.add("period_mean_ms", r.period_mean_ms);
  json.add("period_sd_ms", r.period_sd_ms);
  json.add("period_max_ms", r.period_max_ms);
  json.end_object();
}

void camera(const SegmentSnapshot& s, JsonWriter& json) {
  json.begin_object("camera");
  json.add("state", s.has_camera ? name(s.camera.state) : name(ToolState::never_seen));
  json.add("name", s.camera.name);
  json.add("reason", s.camera.reason);
  json.add("width", s.camera.width);
  json.add("height", s.camera.height);
  json.add("frames", s.camera.frames);
  json.add("last_good_ns", s.camera.last_good);
  rate(s.frame_rate, s.camera.nominal_hz, json);
  json.end_object();
}

/// What is not ok is null, never a number.
void pose(const SensorSnapshot& x, Nanoseconds now, JsonWriter& json) {
  const ToolState state = aged(x.pose.state, x.pose.time, now);
  json.add("pose_state", name(state));
  json.add("pose_age_ms", milliseconds_from(now - x.pose.time));
  if (!usable(state)) return json.add_null("position_mm");
  json.begin_array("position_mm");
  for (int i = 0; i < 3; ++i) json.add("", x.pose.world_from_sensor.translation()(i));
  json.end_array();
}

void sensor(const SensorSnapshot& x, Nanoseconds now, JsonWriter& json) {
  json.begin_object();
  json.add("station", x.station + 1);
  json.add("role", name(x.status.role));
  json.add("name", x.status.name);
  json.add("state", name(x.status.state));
  json.add("reason", x.status.reason);
  json.add("samples", x.status.samples);
  json.add("lost", x.status.lost);
  json.add("last_good_ns", x.status.last_good);
  if (x.has_pose) pose(x, now, json);
  rate(x.rate, x.status.nominal_hz, json);
  json.end_object();
}

void latency(const LatencyFigures& l, JsonWriter& json) {
  json.begin_object(l.name);
  json.add("count", l.count);
  json.add("mean_ns", l.mean);
  json.add("p50_ns", l.p50);
  json.add("p95_ns", l.p95);
  json.add("p99_ns", l.p99);
  json.add("max_ns", l.max);
  json.add("last_ns", l.last);
  json.end_object();
}

}  // namespace

std::string as_json(const SegmentSnapshot& s) {
  JsonWriter json;
  json.begin_object();
  json.add("taken_ns", s.taken);
  identity(s.identity, json);
  state(s, json);
  camera(s, json);
  json.begin_array("sensors");
  for (const SensorSnapshot& x : s.sensors) sensor(x, s.taken, json);
  json.end_array();
  json.begin_object("counters");
  for (const CounterValue& c : s.counters) json.add(c.name, c.value);
  json.end_object();
  json.begin_object("latencies");
  for (const LatencyFigures& l : s.latencies) latency(l, json);
  json.end_object();
  json.end_object();
  return json.text();
}

}  // namespace linescope
