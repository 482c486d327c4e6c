// What the camera's thread publishes: scans and their lines.
#include <algorithm>
#include <limits>

#include "ipc/segment_writer.hpp"
#include "ipc/segment_writer_parts.hpp"

namespace linescope {
namespace {

static_assert(sizeof(SurfacePoint) == sizeof(ls_point));

constexpr std::uint64_t published_word(std::uint32_t generation, std::uint32_t lines) {
  return (std::uint64_t{generation} << 32) | lines;
}

template <class Tool>
ls_line_pose pose_of(const LinePose<Tool>& pose) {
  ls_line_pose r{};
  const Eigen::Vector3d& p = pose.world_from_tool.translation();
  const Eigen::Quaterniond& q = pose.world_from_tool.rotation();
  for (int i = 0; i < 3; ++i) r.position[i] = p(i);
  r.quaternion[0] = q.w();
  r.quaternion[1] = q.x();
  r.quaternion[2] = q.y();
  r.quaternion[3] = q.z();
  r.state = static_cast<std::uint32_t>(pose.state);
  return r;
}

ls_line_record record_of(const ScanLineInfo& info) {
  ls_line_record r{};
  r.time_ns = info.time;
  r.frame = info.frame;
  r.poses[0] = pose_of(info.endoscope);
  r.poses[1] = pose_of(info.object);
  r.poses[2] = pose_of(info.harvester);
  r.mean_peak = info.quality.mean_peak;
  r.mean_width = info.quality.mean_width;
  r.mean_snr = info.quality.mean_snr;
  r.mean_deviation = info.quality.mean_deviation;
  r.coverage = info.quality.coverage;
  r.rejected = info.quality.rejected;
  r.pose_gap_ns = info.quality.pose_gap;
  return r;
}

void put_record(std::byte* at, ls_line_record& record, shared::Checksum& sum) {
  shared::copy_in(at, &record, offsetof(ls_line_record, checksum) / 8, sum);
}

/// Points are 20 bytes: an odd number ends in the middle of a word and is filled up with a point that is
/// none.
void put_points(std::byte* at, std::span<const SurfacePoint> points, shared::Checksum& sum) {
  const std::size_t even = points.size() / 2 * 2;
  shared::copy_in(at, points.data(), even * sizeof(ls_point) / 8, sum);
  if (even == points.size()) return;
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  const SurfacePoint last[2] = {points.back(), {Eigen::Vector3f::Constant(kNone), 0, 0}};
  shared::copy_in(at + even * sizeof(ls_point), last, sizeof last / 8, sum);
}

}  // namespace

void SegmentWriter::begin_scan(Nanoseconds now, ScanCause cause) {
  Parts& p = *parts_;
  ++p.scan_id;
  p.scan_started = now;
  count(Counter::scans_started);
  p.begin_generation(0, 0, static_cast<std::uint32_t>(cause));
}

void SegmentWriter::undo_to(std::uint32_t lines) {
  Parts& p = *parts_;
  if (lines >= p.lines) return;
  count(Counter::lines_undone, p.lines - lines);
  std::uint64_t points = 0;
  if (lines > 0) {
    const ls_line_record& last = *p.line(lines - 1);
    points = last.first_point + (last.point_count + 1ULL) / 2 * 2;
  }
  p.begin_generation(lines, points, LS_SCAN_UNDONE);
}

void SegmentWriter::Parts::begin_generation(std::uint32_t kept, std::uint64_t points, std::uint32_t cause) {
  ls_scan_record record{};
  record.generation = ++generation;
  record.scan_id = scan_id;
  record.started_ns = scan_started;
  record.first_serial = next_serial;
  record.kept_lines = kept;
  record.cause = cause;
  scans.publish(record);
  lines = kept;
  points_used = points;
  set_full(0);
  // Nothing of the former generation is overwritten before this is visible.
  shared::store(header().published, published_word(generation, kept));
  shared::store(header().points_used, points_used);
  announcer.announce(Topic::lines);
}

ls_line_record* SegmentWriter::Parts::line(std::uint32_t index) const {
  const ls_section& section = plan[LS_SECTION_LINES];
  return reinterpret_cast<ls_line_record*>(segment.data() + section.offset +
                                           std::size_t{section.record_bytes} * index);
}

void SegmentWriter::Parts::set_full(std::uint32_t what) {
  if (full == what) return;
  full = what;
  shared::store(header().full, what);
  announcer.announce(Topic::status);
}

void SegmentWriter::set_scanning(bool scanning) {
  if (scanning && parts_->generation == 0) begin_scan(monotonic_now());
  parts_->scanning = scanning;
  shared::store(parts_->header().scanning, scanning ? 1U : 0U);
  parts_->announcer.announce(Topic::status);
}

PublishOutcome SegmentWriter::refuse_line(PublishOutcome outcome, Counter why) {
  count(why);
  return outcome;
}

PublishOutcome SegmentWriter::publish_line(const ScanLineInfo& info, std::span<const SurfacePoint> points) {
  Parts& p = *parts_;
  count(Counter::lines_offered);
  if (!p.scanning) return refuse_line(PublishOutcome::not_scanning, Counter::lines_not_scanning);
  if (points.empty() || points.size() > p.options.points_per_line) {
    return refuse_line(PublishOutcome::invalid, Counter::lines_invalid);
  }
  const std::size_t room = (points.size() + 1) / 2 * 2;
  const bool lines_full = p.lines >= p.options.line_capacity;
  if (lines_full || room > p.options.point_capacity - p.points_used) {
    p.set_full(lines_full ? 1 : 2);
    count(Counter::points_segment_full, points.size());
    return refuse_line(PublishOutcome::full, Counter::lines_segment_full);
  }
  p.announcer.ring_ahead(Topic::lines);
  p.store_line(info, points);
  p.announcer.announce(Topic::lines);
  p.fetch_next_line();
  count(Counter::lines_published);
  count(Counter::points_published, points.size());
  return PublishOutcome::stored;
}

void SegmentWriter::Parts::store_line(const ScanLineInfo& info, std::span<const SurfacePoint> points) {
  ls_line_record record = record_of(info);
  record.serial = next_serial++;
  record.first_point = points_used;
  record.point_count = static_cast<std::uint32_t>(points.size());
  record.scan_id = scan_id;
  record.index = lines;
  shared::Checksum sum;
  put_record(reinterpret_cast<std::byte*>(line(lines)), record, sum);
  put_points(segment.data() + plan[LS_SECTION_POINTS].offset + points_used * sizeof(ls_point), points, sum);
  shared::store(line(lines)->checksum, sum.value());
  points_used += (points.size() + 1) / 2 * 2;
  shared::store(header().next_serial, next_serial);
  shared::store(header().points_used, points_used);
  shared::store(header().published, published_word(generation, ++lines));
}

/// The next line will lie where nothing was touched for a whole scan: its start is asked for now, when nobody
/// waits for it. All of it would cost the writer more than it saves the reader.
void SegmentWriter::Parts::fetch_next_line() const {
  constexpr std::size_t kAhead = 4096;
  const std::byte* at = segment.data() + plan[LS_SECTION_POINTS].offset + points_used * sizeof(ls_point);
  const std::size_t left = (options.point_capacity - points_used) * sizeof(ls_point);
  for (std::size_t i = 0; i < std::min(left, kAhead); i += LS_CACHE_LINE) __builtin_prefetch(at + i, 1);
}

bool SegmentWriter::scanning() const {
  return parts_->scanning;
}
bool SegmentWriter::full() const {
  return parts_->full != 0;
}
std::uint32_t SegmentWriter::lines_in_scan() const {
  return parts_->lines;
}
std::uint32_t SegmentWriter::scan_id() const {
  return parts_->scan_id;
}

}  // namespace linescope
