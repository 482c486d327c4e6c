#include "ipc/segment_plan.hpp"

#include <fmt/format.h>

#include "ipc/segment_counters.h"

namespace linescope {
namespace {

constexpr std::uint64_t rounded(std::uint64_t bytes, std::uint64_t to) {
  return (bytes + to - 1) / to * to;
}

/// What every reader expects of a kind: rings (0: flat array), smallest distance of two records, fewest
/// records.
struct Expectation {
  std::uint32_t rings;
  std::uint32_t record_bytes;
  std::uint32_t records;
};

constexpr std::array<Expectation, kSectionKinds> kExpected{{
    {0, 0, 0},
    {1, sizeof(ls_state_record), 2},
    {LS_STATIONS, sizeof(ls_sensor_record), 2},
    {1, sizeof(ls_camera_record), 2},
    {LS_TEXTS, sizeof(ls_text_record), 2},
    {LS_STATIONS, sizeof(ls_pose_record), 2},
    {1, sizeof(ls_scan_record), 2},
    {0, sizeof(ls_line_record), 1},
    {0, sizeof(ls_point), 2},
    {1, sizeof(ls_picture_record), 2},
    {1, sizeof(ls_frame_record), 2},
    {0, sizeof(ls_counter), 1},
    {0, sizeof(ls_latency), 1},
}};

class Planner {
 public:
  void add(ls_section_kind kind, std::uint32_t records, std::uint64_t record_bytes) {
    ls_section& s = plan_.sections[kind];
    s.kind = kind;
    s.record_bytes = static_cast<std::uint32_t>(record_bytes);
    s.record_count = records;
    s.ring_count = kExpected[kind].rings;
    const std::uint64_t ring_head = s.ring_count > 0 ? sizeof(ls_ring) : 0;
    s.ring_bytes = rounded(ring_head + record_bytes * records, LS_CACHE_LINE);
    s.bytes = s.ring_bytes * std::max(1U, s.ring_count);
    s.offset = plan_.total_bytes;
    plan_.total_bytes += s.bytes;
    if (s.ring_count == 0) s.ring_bytes = 0;
  }
  SegmentPlan finished() {
    plan_.total_bytes = rounded(plan_.total_bytes, LS_HEADER_BYTES);
    return plan_;
  }

 private:
  SegmentPlan plan_{{}, LS_HEADER_BYTES};
};

tl::unexpected<Error> impossible(const ls_section& s, const char* what) {
  return fail(
      ErrorCode::unreadable,
      fmt::format("its table of sections is damaged (section {}: {}): restart the daemon", s.kind, what));
}

Result<void> check_section(const ls_section& s, std::uint64_t total) {
  const Expectation& expected = kExpected[s.kind];
  if (s.offset % LS_CACHE_LINE != 0 || s.offset < LS_HEADER_BYTES) return impossible(s, "offset");
  if (s.offset > total || s.bytes > total - s.offset) return impossible(s, "reaches beyond the end");
  if (s.record_bytes < expected.record_bytes || (s.kind != LS_SECTION_POINTS && s.record_bytes % 8 != 0)) {
    return impossible(s, "record size");
  }
  if (s.kind == LS_SECTION_POINTS && s.record_bytes != sizeof(ls_point)) return impossible(s, "point size");
  if (s.record_count < expected.records) return impossible(s, "record count");
  if (s.ring_count != expected.rings) return impossible(s, "ring count");
  const std::uint64_t records = std::uint64_t{s.record_bytes} * s.record_count;
  if (s.ring_count == 0)
    return records <= s.bytes ? Result<void>{} : impossible(s, "too short for its records");
  if (s.ring_bytes % LS_CACHE_LINE != 0 || s.ring_bytes > s.bytes / s.ring_count)
    return impossible(s, "ring size");
  return records <= s.ring_bytes - sizeof(ls_ring) && s.ring_bytes >= sizeof(ls_ring)
             ? Result<void>{}
             : impossible(s, "too short for its records");
}

Result<void> check_contents(const ls_header& header, const SegmentPlan& plan) {
  const std::uint64_t samples = std::uint64_t{header.picture_samples} * sizeof(ls_line_sample);
  const ls_section& pictures = plan[LS_SECTION_PICTURES];
  if (samples > pictures.record_bytes - sizeof(ls_picture_record))
    return impossible(pictures, "line samples");
  if (header.counter_count > plan[LS_SECTION_COUNTERS].record_count)
    return impossible(plan[LS_SECTION_COUNTERS], "count");
  if (header.latency_count > plan[LS_SECTION_LATENCIES].record_count)
    return impossible(plan[LS_SECTION_LATENCIES], "count");
  return {};
}

}  // namespace

SegmentPlan plan_segment(const SegmentOptions& o) {
  constexpr std::uint32_t kStatusRecords = 8;
  constexpr std::uint32_t kScanRecords = 64;
  constexpr std::uint32_t kSpareCounters = 128, kSpareLatencies = 16;
  static_assert(LS_COUNTER_COUNT <= kSpareCounters && LS_LATENCY_COUNT <= kSpareLatencies);
  const std::uint64_t picture =
      sizeof(ls_picture_record) + o.picture_samples * sizeof(ls_line_sample) + o.picture_bytes;
  Planner planner;
  planner.add(LS_SECTION_STATE, kStatusRecords, sizeof(ls_state_record));
  planner.add(LS_SECTION_SENSORS, kStatusRecords, sizeof(ls_sensor_record));
  planner.add(LS_SECTION_CAMERA, kStatusRecords, sizeof(ls_camera_record));
  planner.add(LS_SECTION_COUNTERS, kSpareCounters, sizeof(ls_counter));
  planner.add(LS_SECTION_LATENCIES, kSpareLatencies, sizeof(ls_latency));
  planner.add(LS_SECTION_SCANS, kScanRecords, sizeof(ls_scan_record));
  planner.add(LS_SECTION_FRAMES, o.frame_history, sizeof(ls_frame_record));
  planner.add(LS_SECTION_TEXTS, 2, sizeof(ls_text_record) + rounded(o.text_bytes, 8));
  planner.add(LS_SECTION_POSES, o.pose_history, sizeof(ls_pose_record));
  planner.add(LS_SECTION_PICTURES, o.picture_slots, rounded(picture, LS_CACHE_LINE));
  planner.add(LS_SECTION_LINES, o.line_capacity, sizeof(ls_line_record));
  planner.add(LS_SECTION_POINTS, o.point_capacity, sizeof(ls_point));
  return planner.finished();
}

Result<SegmentPlan> checked_plan(const ls_header& header, std::uint64_t mapped_bytes) {
  SegmentPlan plan;
  plan.total_bytes = mapped_bytes;
  if (header.section_count > LS_MAX_SECTIONS) {
    return fail(ErrorCode::unreadable,
                fmt::format("its header is damaged ({} sections): restart the daemon", header.section_count));
  }
  for (std::uint32_t i = 0; i < header.section_count; ++i) {
    const ls_section& s = header.sections[i];
    if (s.kind == 0 || s.kind >= kSectionKinds) continue;
    if (auto ok = check_section(s, mapped_bytes); !ok) return tl::unexpected(ok.error());
    plan.sections[s.kind] = s;
  }
  for (std::uint32_t kind = 1; kind < kSectionKinds; ++kind) {
    if (plan.sections[kind].kind == kind) continue;
    return fail(ErrorCode::unreadable,
                fmt::format("its header is damaged (section {} is missing): restart the daemon", kind));
  }
  if (auto ok = check_contents(header, plan); !ok) return tl::unexpected(ok.error());
  return plan;
}

}  // namespace linescope
