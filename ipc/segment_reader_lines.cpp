// Copying out lines and points of a scan, and accounting for what was missed.
#include <algorithm>

#include "ipc/segment_reader_parts.hpp"

namespace linescope {
namespace {

constexpr std::size_t kRecordWords = offsetof(ls_line_record, checksum) / 8;

std::uint32_t generation_of(std::uint64_t published) {
  return static_cast<std::uint32_t>(published >> 32);
}
std::uint32_t lines_of(std::uint64_t published) {
  return static_cast<std::uint32_t>(published);
}

template <class Tool>
LinePose<Tool> pose_of(const ls_line_pose& r) {
  const Eigen::Quaterniond rotation(r.quaternion[0], r.quaternion[1], r.quaternion[2], r.quaternion[3]);
  return {{rotation, {r.position[0], r.position[1], r.position[2]}}, tool_state(r.state)};
}

Line line_of(const ls_line_record& r) {
  Line line;
  line.time = r.time_ns;
  line.frame = r.frame;
  line.endoscope = pose_of<Endoscope>(r.poses[0]);
  line.object = pose_of<Object>(r.poses[1]);
  line.harvester = pose_of<Harvester>(r.poses[2]);
  line.quality = {r.mean_peak, r.mean_width, r.mean_snr,   r.mean_deviation,
                  r.coverage,  r.rejected,   r.pose_gap_ns};
  line.serial = r.serial;
  line.scan_id = r.scan_id;
  line.index = r.index;
  line.point_count = r.point_count;
  line.checksum = r.checksum;
  return line;
}

struct Generation {
  std::uint32_t number = 0;
  std::uint32_t lines = 0;
  ls_scan_record scan{};
};

/// Counts what lies between the serial that was expected and the one that comes.
void skip_to(std::uint64_t serial, LineCursor& cursor, LineBatch& batch) {
  if (serial <= cursor.next_serial) return;
  batch.missed += serial - cursor.next_serial;
  cursor.next_serial = serial;
}

void enter(const Generation& generation, LineCursor& cursor, LineBatch& batch) {
  batch.scan_id = generation.scan.scan_id;
  if (cursor.generation != generation.number) {
    batch.restarted = cursor.generation != 0;
    cursor.generation = generation.number;
    cursor.next_line = 0;
  }
}

/// New lines are numbered without gaps; kept ones come from before.
bool serial_fits(const ls_line_record& r, const ls_scan_record& scan) {
  if (r.index < scan.kept_lines) return r.serial < scan.first_serial;
  return r.serial - scan.first_serial == r.index - scan.kept_lines;
}

/// Points, and the filling point of an odd line, into the end of the buffer; true when the checksum holds.
bool copy_points(const std::byte* from, const ls_line_record& r, shared::Checksum& sum, PointBuffer& points) {
  const std::size_t before = points.size();
  const std::size_t padded = (std::size_t{r.point_count} + 1) / 2 * 2;
  points.resize(before + padded);
  shared::copy_out(points.data() + before, from, padded * sizeof(ls_point) / 8, sum);
  const bool whole = sum.value() == r.checksum;
  points.resize(whole ? before + r.point_count : before);
  return whole;
}

}  // namespace

/// Reads the lines of one generation; the caller has to check afterwards that it still is the current one.
class SegmentReader::LineCopier {
 public:
  LineCopier(const Parts& parts, const Generation& generation, LineBatch& batch)
      : parts_(parts),
        generation_(generation),
        batch_(batch),
        point_room_(parts.plan[LS_SECTION_POINTS].record_count) {}

  ReadOutcome run(LineCursor& cursor, std::size_t max_points) {
    enter(generation_, cursor, batch_);
    reserve(cursor.next_line, max_points);
    while (true) {
      // Behind the last kept line follow those of this generation; what was undone in between is missed.
      if (cursor.next_line >= generation_.scan.kept_lines)
        skip_to(generation_.scan.first_serial, cursor, batch_);
      if (cursor.next_line >= generation_.lines) return ReadOutcome::ok;
      const ReadOutcome outcome = copy(cursor, max_points);
      if (outcome != ReadOutcome::ok) return outcome == ReadOutcome::nothing ? ReadOutcome::ok : outcome;
      ++cursor.next_line;
    }
  }

 private:
  const ls_line_record& shared_line(std::uint32_t index) const {
    return shared::RingOut::as<ls_line_record>(parts_.element(LS_SECTION_LINES, index));
  }

  bool plausible(const ls_line_record& r, std::uint32_t index) const {
    return r.index == index && r.scan_id == generation_.scan.scan_id && r.first_point % 2 == 0 &&
           r.first_point <= point_room_ &&
           (std::uint64_t{r.point_count} + 1) / 2 * 2 <= point_room_ - r.first_point &&
           serial_fits(r, generation_.scan);
  }

  /// One allocation instead of many; the figures are only a guess until they are checked line by line.
  void reserve(std::uint32_t first, std::size_t max_points) {
    if (first >= generation_.lines) return;
    const std::uint64_t begin = shared::load(shared_line(first).first_point);
    const ls_line_record& last = shared_line(generation_.lines - 1);
    const std::uint64_t end =
        std::min(point_room_, shared::load(last.first_point) + shared::load(last.point_count) + 1);
    if (begin < end) batch_.points.reserve(std::min<std::uint64_t>(end - begin, max_points) + 1);
    batch_.lines.reserve(std::min<std::size_t>(generation_.lines - first, max_points));
  }

  /// `nothing`: no more room in this batch.
  ReadOutcome copy(LineCursor& cursor, std::size_t max_points) {
    ls_line_record r;
    shared::Checksum sum;
    const ls_line_record& from = shared_line(cursor.next_line);
    shared::copy_out(&r, &from, kRecordWords, sum);
    r.checksum = shared::load(from.checksum);
    if (!plausible(r, cursor.next_line)) return ReadOutcome::corrupt;
    if (!batch_.lines.empty() && batch_.points.size() + r.point_count > max_points) {
      batch_.more = true;
      return ReadOutcome::nothing;
    }
    take(r, sum, cursor);
    return ReadOutcome::ok;
  }

  void take(const ls_line_record& r, shared::Checksum& sum, LineCursor& cursor) {
    const std::size_t first = batch_.points.size();
    const std::byte* points = parts_.element(LS_SECTION_POINTS, r.first_point);
    if (copy_points(points, r, sum, batch_.points)) {
      batch_.lines.push_back(line_of(r));
      batch_.lines.back().first_point = first;
    } else {
      ++batch_.damaged;
    }
    if (r.serial < cursor.next_serial) return;
    skip_to(r.serial, cursor, batch_);
    ++cursor.next_serial;
  }

  const Parts& parts_;
  const Generation& generation_;
  LineBatch& batch_;
  std::uint64_t point_room_;
};

namespace {

bool read_scan_record(const shared::RingOut& ring, Generation& generation) {
  const std::uint64_t index = generation.number - 1ULL;
  shared::get(generation.scan, shared::RingOut::as<ls_scan_record>(ring.place(index)));
  return ring.intact(index) && generation.scan.index == index &&
         generation.scan.generation == generation.number;
}

}  // namespace

ReadOutcome SegmentReader::read_lines(LineCursor& cursor, LineBatch& batch, std::size_t max_points) const {
  batch.clear();
  const Parts& p = *parts_;
  if (!p.intact()) return ReadOutcome::corrupt;
  for (int i = 0; i < shared::kTries; ++i) {
    batch.clear();
    const std::uint64_t published = shared::load(p.header().published);
    Generation generation{generation_of(published), lines_of(published), {}};
    if (generation.number == 0) return ReadOutcome::nothing;
    LineCursor next =
        cursor.session_id == p.identity.session_id ? cursor : LineCursor{.session_id = p.identity.session_id};
    ReadOutcome outcome = ReadOutcome::corrupt;
    if (read_scan_record(p.ring(LS_SECTION_SCANS), generation) &&
        generation.scan.kept_lines <= generation.lines &&
        generation.lines <= p.plan[LS_SECTION_LINES].record_count) {
      outcome = LineCopier(p, generation, batch).run(next, max_points);
    }
    // Only now: whatever was found above may be a mixture when the writer has begun the next generation
    // meanwhile.
    if (generation_of(shared::load(p.header().published)) != generation.number) continue;
    if (outcome != ReadOutcome::ok) return batch.clear(), outcome;
    cursor = next;
    const bool quiet = batch.lines.empty() && !batch.restarted && batch.missed == 0 && batch.damaged == 0;
    return quiet ? ReadOutcome::nothing : ReadOutcome::ok;
  }
  batch.clear();
  return ReadOutcome::overtaken;
}

void LineBatch::clear() {
  lines.clear();
  points.clear();
  scan_id = 0;
  restarted = false;
  missed = 0;
  more = false;
  damaged = 0;
}

}  // namespace linescope
