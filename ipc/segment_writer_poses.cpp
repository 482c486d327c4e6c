// What the tracker's thread publishes, and the latency figures of all threads.
#include <algorithm>

#include "ipc/segment_statistics.hpp"
#include "ipc/segment_writer.hpp"
#include "ipc/segment_writer_parts.hpp"

namespace linescope {
namespace {

ls_pose_record record_of(const PoseSample& sample) {
  ls_pose_record r{};
  r.time_ns = sample.time;
  const Eigen::Vector3d& p = sample.world_from_sensor.translation();
  const Eigen::Quaterniond& q = sample.world_from_sensor.rotation();
  std::copy_n(p.data(), 3, r.position);
  const double wxyz[4] = {q.w(), q.x(), q.y(), q.z()};
  std::copy_n(wxyz, 4, r.quaternion);
  r.frame_count = sample.frame_count;
  r.distortion = sample.distortion;
  r.station = sample.station;
  r.state = static_cast<std::uint32_t>(sample.state);
  return r;
}

}  // namespace

void SegmentWriter::publish_pose(const PoseSample& sample) {
  if (sample.station >= LS_STATIONS) return count(Counter::tracker_samples_unknown_station);
  ls_pose_record record = record_of(sample);
  parts_->poses[sample.station].publish(record);
  count(Counter::tracker_samples_published);
  parts_->announcer.announce(Topic::poses);
}

void SegmentWriter::set_sensor_status(int station, const SensorStatus& status) {
  if (station < 0 || station >= LS_STATIONS) return count(Counter::tracker_samples_unknown_station);
  ls_sensor_record r{};
  r.time_ns = status.time;
  r.last_good_ns = status.last_good;
  r.samples = status.samples;
  r.lost = status.lost;
  r.role = static_cast<std::uint32_t>(status.role);
  r.state = static_cast<std::uint32_t>(status.state);
  r.nominal_hz = status.nominal_hz;
  set_text(r.name, status.name);
  set_text(r.reason, status.reason);
  parts_->sensors[static_cast<std::size_t>(station)].publish(r);
  parts_->announcer.announce(Topic::status);
}

void SegmentWriter::record_latency(LatencyStage stage, Nanoseconds duration) {
  ls_latency& l = parts_->latencies()[static_cast<std::uint32_t>(stage)];
  const auto ns = static_cast<std::uint64_t>(std::max<Nanoseconds>(duration, 0));
  shared::add(l.buckets[latency_bucket(ns)], std::uint64_t{1});
  shared::add(l.sum_ns, ns);
  shared::store(l.last_ns, ns);
  std::uint64_t largest = shared::load(l.max_ns);
  while (ns > largest &&
         !__atomic_compare_exchange_n(&l.max_ns, &largest, ns, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {
  }
  shared::add(l.count, std::uint64_t{1});
}

}  // namespace linescope
