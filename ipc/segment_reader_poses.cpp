// Poses out of their rings, and the rates measured from the times in them.
#include <algorithm>
#include <optional>

#include "ipc/segment_reader_parts.hpp"

namespace linescope {
namespace {

PoseSample sample_of(const ls_pose_record& r) {
  PoseSample s;
  s.time = r.time_ns;
  s.frame_count = r.frame_count;
  s.station = static_cast<std::uint8_t>(r.station);
  s.state = tool_state(r.state);
  s.distortion = r.distortion;
  const Eigen::Quaterniond rotation(r.quaternion[0], r.quaternion[1], r.quaternion[2], r.quaternion[3]);
  s.world_from_sensor = {rotation, {r.position[0], r.position[1], r.position[2]}};
  return s;
}

bool plausible(const ls_pose_record& r, std::uint64_t index, int station) {
  return r.index == index && r.station == static_cast<std::uint32_t>(station);
}

/// Oldest record that can still be copied whole, with one slot to spare for a writer at work.
std::uint64_t oldest(std::uint64_t head, std::uint32_t capacity) {
  return head < capacity ? 0 : head - capacity + 1;
}

/// Times of the newest records, oldest first. Stops at the first that was overwritten meanwhile.
template <class Record>
std::vector<Nanoseconds> times_of(const shared::RingOut& ring) {
  std::vector<Nanoseconds> times;
  const std::uint64_t head = shared::load(ring.head());
  for (std::uint64_t i = head; i-- > oldest(head, ring.capacity());) {
    Record r;
    shared::get(r, shared::RingOut::as<Record>(ring.place(i)));
    if (!ring.intact(i) || r.index != i) break;
    times.push_back(r.time_ns);
  }
  std::reverse(times.begin(), times.end());
  return times;
}

}  // namespace

ReadOutcome SegmentReader::latest_pose(int station, PoseSample& out) const {
  if (station < 0 || station >= LS_STATIONS) return ReadOutcome::nothing;
  if (!parts_->intact()) return ReadOutcome::corrupt;
  ls_pose_record r;
  const ReadOutcome outcome =
      read_latest(parts_->ring(LS_SECTION_POSES, static_cast<std::uint32_t>(station)), r);
  if (outcome != ReadOutcome::ok) return outcome;
  if (!plausible(r, r.index, station)) return ReadOutcome::corrupt;
  out = sample_of(r);
  return ReadOutcome::ok;
}

namespace {

/// Copies records backwards from `head` to `first`, until `use` gives false or the writer has come that far:
/// what it overwrites meanwhile is the far end. Records of the returned number and above were copied;
/// nothing: one of them is impossible.
template <class Use>
std::optional<std::uint64_t> copy_back(const shared::RingOut& ring, std::uint64_t head, std::uint64_t first,
                                       int station, const Use& use) {
  std::uint64_t i = head;
  for (; i > first; --i) {
    ls_pose_record r;
    shared::get(r, shared::RingOut::as<ls_pose_record>(ring.place(i - 1)));
    if (!ring.intact(i - 1)) break;
    if (!plausible(r, i - 1, station)) return std::nullopt;
    if (!use(r)) break;
  }
  return i;
}

}  // namespace

ReadOutcome SegmentReader::pose_history(int station, Nanoseconds from, Nanoseconds to,
                                        std::vector<PoseSample>& out) const {
  if (station < 0 || station >= LS_STATIONS) return ReadOutcome::nothing;
  if (!parts_->intact()) return ReadOutcome::corrupt;
  const shared::RingOut ring = parts_->ring(LS_SECTION_POSES, static_cast<std::uint32_t>(station));
  const std::uint64_t head = shared::load(ring.head());
  if (head == 0) return ReadOutcome::nothing;
  const auto begin = static_cast<std::ptrdiff_t>(out.size());
  bool earlier = false;
  const auto reached = copy_back(ring, head, oldest(head, ring.capacity()), station, [&](const auto& r) {
    earlier = r.time_ns < from;
    if (!earlier && r.time_ns <= to) out.push_back(sample_of(r));
    return !earlier;
  });
  if (!reached) return out.resize(static_cast<std::size_t>(begin)), ReadOutcome::corrupt;
  std::reverse(out.begin() + begin, out.end());
  return earlier || *reached == 0 ? ReadOutcome::ok : ReadOutcome::overtaken;
}

ReadOutcome SegmentReader::new_poses(int station, PoseCursor& cursor, std::vector<PoseSample>& out,
                                     std::uint64_t& missed) const {
  missed = 0;
  if (station < 0 || station >= LS_STATIONS) return ReadOutcome::nothing;
  if (!parts_->intact()) return ReadOutcome::corrupt;
  const shared::RingOut ring = parts_->ring(LS_SECTION_POSES, static_cast<std::uint32_t>(station));
  const std::uint64_t head = shared::load(ring.head());
  const std::uint64_t next = cursor.session_id == parts_->identity.session_id ? cursor.next : 0;
  if (head < next) return ReadOutcome::corrupt;
  const auto begin = static_cast<std::ptrdiff_t>(out.size());
  const auto reached =
      copy_back(ring, head, std::max(next, oldest(head, ring.capacity())), station, [&](const auto& r) {
        out.push_back(sample_of(r));
        return true;
      });
  if (!reached) return out.resize(static_cast<std::size_t>(begin)), ReadOutcome::corrupt;
  std::reverse(out.begin() + begin, out.end());
  missed = *reached - next;
  cursor = {head, parts_->identity.session_id};
  return head == next ? ReadOutcome::nothing : ReadOutcome::ok;
}

RateFigures SegmentReader::pose_rate(int station) const {
  if (station < 0 || station >= LS_STATIONS || !parts_->intact()) return {};
  return rate_figures(
      times_of<ls_pose_record>(parts_->ring(LS_SECTION_POSES, static_cast<std::uint32_t>(station))));
}

RateFigures SegmentReader::frame_rate() const {
  if (!parts_->intact()) return {};
  return rate_figures(times_of<ls_frame_record>(parts_->ring(LS_SECTION_FRAMES)));
}

}  // namespace linescope
