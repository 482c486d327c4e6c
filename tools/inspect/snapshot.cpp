#include "tools/inspect/snapshot.hpp"

namespace linescope {
namespace {

bool take_sensor(const SegmentReader& reader, int station, SegmentSnapshot& s) {
  SensorSnapshot sensor;
  sensor.station = station;
  const ReadOutcome status = reader.sensor_status(station, sensor.status);
  const ReadOutcome pose = reader.latest_pose(station, sensor.pose);
  sensor.has_status = status == ReadOutcome::ok;
  sensor.has_pose = pose == ReadOutcome::ok;
  if (sensor.has_pose) sensor.rate = reader.pose_rate(station);
  if (sensor.has_status || sensor.has_pose) s.sensors.push_back(std::move(sensor));
  return status != ReadOutcome::corrupt && pose != ReadOutcome::corrupt;
}

/// Reads the whole scan: also a check of every line's checksum.
bool take_scan(const SegmentReader& reader, SegmentSnapshot& s) {
  LineCursor cursor;
  LineBatch batch;
  batch.more = true;
  while (batch.more) {
    const ReadOutcome outcome = reader.read_lines(cursor, batch, 100'000);
    if (outcome == ReadOutcome::corrupt || batch.damaged > 0) return false;
    if (outcome != ReadOutcome::ok) break;
    if (batch.restarted) s.lines = s.points = 0;
    s.scan_id = batch.scan_id;
    s.lines += batch.lines.size();
    s.points += batch.points.size();
  }
  return true;
}

}  // namespace

SnapshotResult take_snapshot(SegmentReader& reader, Nanoseconds now) {
  SnapshotResult result;
  SegmentSnapshot& s = result.snapshot;
  s.identity = reader.identity();
  s.taken = now;
  s.life = reader.report(now);
  bool good = reader.status(s.daemon) != ReadOutcome::corrupt;
  const ReadOutcome camera = reader.camera_status(s.camera);
  s.has_camera = camera == ReadOutcome::ok;
  good = good && camera != ReadOutcome::corrupt;
  s.frame_rate = reader.frame_rate();
  s.scanning = reader.scanning();
  s.full = reader.full();
  for (int station = 0; station < kMaxStations; ++station) good = take_sensor(reader, station, s) && good;
  good = take_scan(reader, s) && good;
  s.counters = reader.counters();
  s.latencies = reader.latencies();
  result.corrupt = !good;
  return result;
}

}  // namespace linescope
