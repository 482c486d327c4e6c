// Everything linescope-inspect shows, read out of a segment at one moment.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "ipc/segment_reader.hpp"

namespace linescope {

struct SensorSnapshot {
  int station = 0;
  bool has_status = false;
  bool has_pose = false;
  SensorStatus status;
  PoseSample pose;
  RateFigures rate;
};

struct SegmentSnapshot {
  SegmentIdentity identity;
  LifeReport life;
  Nanoseconds taken = 0;
  DaemonStatus daemon;
  bool scanning = false;
  bool full = false;
  std::uint32_t scan_id = 0;
  std::size_t lines = 0;
  std::size_t points = 0;
  bool has_camera = false;
  CameraReport camera;
  RateFigures frame_rate;
  std::vector<SensorSnapshot> sensors;  ///< stations of which anything is known
  std::vector<CounterValue> counters;
  std::vector<LatencyFigures> latencies;
};

struct SnapshotResult {
  SegmentSnapshot snapshot;
  bool corrupt = false;
};

SnapshotResult take_snapshot(SegmentReader& reader, Nanoseconds now);

/// For people: a page of text. `all_counters`: also those that are zero.
std::string as_text(const SegmentSnapshot& snapshot, bool all_counters);

/// For machines: one line of JSON. Times in ns, durations with their unit in the key; numbers that are not
/// finite are null.
std::string as_json(const SegmentSnapshot& snapshot);

}  // namespace linescope
