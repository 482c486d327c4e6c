#include "ipc/segment_reader.hpp"

#include <fmt/format.h>

#include "ipc/segment_reader_parts.hpp"

namespace linescope {
namespace {

constexpr Nanoseconds kNameEvery = 50 * kMillisecond;

std::string sentence(Life life, const SegmentIdentity& who, Nanoseconds silent_for) {
  switch (life) {
    case Life::live:
      return {};
    case Life::silent:
      return fmt::format(
          "the daemon (segment {}, pid {}) has been silent for {:.1f} s: it has crashed, is stopped or "
          "overloaded",
          who.name, who.writer_pid, seconds_from(silent_for));
    case Life::closed:
      return fmt::format("the daemon (segment {}, pid {}) has ended", who.name, who.writer_pid);
    case Life::replaced:
      return fmt::format("another daemon has taken over segment {}: attach again", who.name);
    case Life::removed:
      return fmt::format("segment {} was removed: restart the daemon (pid {})", who.name, who.writer_pid);
    case Life::damaged:
      return fmt::format("segment {} was cut short or overwritten: restart the daemon (pid {})", who.name,
                         who.writer_pid);
  }
  return {};
}

}  // namespace

ToolState tool_state(std::uint32_t number) {
  return number <= LS_TOOL_NEVER_SEEN ? static_cast<ToolState>(number) : ToolState::never_seen;
}

SegmentReader::SegmentReader(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
SegmentReader::~SegmentReader() = default;
SegmentReader::SegmentReader(SegmentReader&&) noexcept = default;
SegmentReader& SegmentReader::operator=(SegmentReader&&) noexcept = default;

const SegmentIdentity& SegmentReader::identity() const {
  return parts_->identity;
}

Life SegmentReader::Parts::examine(Nanoseconds now) const {
  if (!intact()) return Life::damaged;
  if (now - name_checked >= kNameEvery || now < name_checked) {
    name_checked = now;
    const ObjectFacts named = segment.facts_of_name();
    name_is_gone = named.inode == 0;
    has_name = named.same_object(segment.facts());
  }
  const ls_header& h = header();
  if (shared::load(h.session_id) != identity.session_id || shared::load(h.magic) != LS_MAGIC)
    return Life::damaged;
  if (shared::load(h.replaced_by) != 0 || (!has_name && !name_is_gone)) return Life::replaced;
  if (shared::load(h.closed) != 0) return Life::closed;
  if (name_is_gone) return Life::removed;
  const Nanoseconds beat = shared::load(h.heartbeat_ns);
  // A beat from the future is none: the clock is common to all processes.
  const bool fresh = beat <= now + kSecond && beat > now - kDeadAfter;
  return fresh ? Life::live : Life::silent;
}

Life SegmentReader::life(Nanoseconds now) const {
  return parts_->examine(now);
}

LifeReport SegmentReader::report(Nanoseconds now) const {
  LifeReport r;
  r.life = parts_->examine(now);
  if (r.life != Life::damaged)
    r.silent_for =
        static_cast<Nanoseconds>(static_cast<std::uint64_t>(now) -
                                 static_cast<std::uint64_t>(shared::load(parts_->header().heartbeat_ns)));
  r.text = sentence(r.life, parts_->identity, r.silent_for);
  return r;
}

ReadOutcome SegmentReader::status(DaemonStatus& out) const {
  if (!parts_->intact()) return ReadOutcome::corrupt;
  ls_state_record r;
  const ReadOutcome outcome = read_latest(parts_->ring(LS_SECTION_STATE), r);
  if (outcome != ReadOutcome::ok) return outcome;
  if (r.state > LS_STATE_STOPPING) return ReadOutcome::corrupt;
  out.state = static_cast<DaemonState>(r.state);
  out.since = r.since_ns;
  out.reason = text_of(r.reason);
  return ReadOutcome::ok;
}

ReadOutcome SegmentReader::sensor_status(int station, SensorStatus& out) const {
  if (station < 0 || station >= LS_STATIONS) return ReadOutcome::nothing;
  if (!parts_->intact()) return ReadOutcome::corrupt;
  ls_sensor_record r;
  const ReadOutcome outcome =
      read_latest(parts_->ring(LS_SECTION_SENSORS, static_cast<std::uint32_t>(station)), r);
  if (outcome != ReadOutcome::ok) return outcome;
  out.role = r.role <= LS_ROLE_OTHER ? static_cast<SensorRole>(r.role) : SensorRole::other;
  out.state = tool_state(r.state);
  out.time = r.time_ns;
  out.last_good = r.last_good_ns;
  out.samples = r.samples;
  out.lost = r.lost;
  out.nominal_hz = r.nominal_hz;
  out.name = text_of(r.name);
  out.reason = text_of(r.reason);
  return ReadOutcome::ok;
}

ReadOutcome SegmentReader::camera_status(CameraReport& out) const {
  if (!parts_->intact()) return ReadOutcome::corrupt;
  ls_camera_record r;
  const ReadOutcome outcome = read_latest(parts_->ring(LS_SECTION_CAMERA), r);
  if (outcome != ReadOutcome::ok) return outcome;
  out.state = tool_state(r.state);
  out.time = r.time_ns;
  out.last_good = r.last_good_ns;
  out.frames = r.frames;
  out.width = r.width;
  out.height = r.height;
  out.nominal_hz = r.nominal_hz;
  out.exposure_ms = r.exposure_ms;
  out.name = text_of(r.name);
  out.reason = text_of(r.reason);
  return ReadOutcome::ok;
}

bool SegmentReader::scanning() const {
  return parts_->intact() && shared::load(parts_->header().scanning) != 0;
}
bool SegmentReader::full() const {
  return parts_->intact() && shared::load(parts_->header().full) != 0;
}

namespace {

ReadOutcome read_text(const shared::RingOut& ring, std::string& out) {
  for (int i = 0; i < shared::kTries; ++i) {
    const std::uint64_t head = shared::load(ring.head());
    if (head == 0) return ReadOutcome::nothing;
    const std::byte* at = ring.place(head - 1);
    ls_text_record r;
    shared::get(r, shared::RingOut::as<ls_text_record>(at));
    if (!ring.intact(head - 1)) continue;
    if (r.index != head - 1 || r.text_bytes > ring.record_bytes() - sizeof r) return ReadOutcome::corrupt;
    out.resize((r.text_bytes + 7U) / 8U * 8U);
    shared::copy_out(out.data(), at + sizeof r, out.size() / 8);
    if (!ring.intact(head - 1)) continue;
    out.resize(r.text_bytes);
    return ReadOutcome::ok;
  }
  return ReadOutcome::overtaken;
}

}  // namespace

ReadOutcome SegmentReader::configuration(std::string& toml) const {
  if (!parts_->intact()) return ReadOutcome::corrupt;
  return read_text(parts_->ring(LS_SECTION_TEXTS, LS_TEXT_CONFIGURATION), toml);
}

ReadOutcome SegmentReader::calibration(std::string& yaml) const {
  if (!parts_->intact()) return ReadOutcome::corrupt;
  return read_text(parts_->ring(LS_SECTION_TEXTS, LS_TEXT_CALIBRATION), yaml);
}

std::vector<CounterValue> SegmentReader::counters() const {
  std::vector<CounterValue> all;
  if (!parts_->intact()) return all;
  const std::uint32_t used = shared::load(parts_->header().counter_count);
  for (std::uint32_t i = 0; i < used && i < parts_->plan[LS_SECTION_COUNTERS].record_count; ++i) {
    ls_counter c;
    shared::get(c, shared::RingOut::as<ls_counter>(parts_->element(LS_SECTION_COUNTERS, i)));
    all.push_back({text_of(c.name), c.value});
  }
  return all;
}

std::vector<LatencyFigures> SegmentReader::latencies() const {
  std::vector<LatencyFigures> all;
  if (!parts_->intact()) return all;
  const std::uint32_t used = shared::load(parts_->header().latency_count);
  for (std::uint32_t i = 0; i < used && i < parts_->plan[LS_SECTION_LATENCIES].record_count; ++i) {
    ls_latency l;
    shared::get(l, shared::RingOut::as<ls_latency>(parts_->element(LS_SECTION_LATENCIES, i)));
    all.push_back(latency_figures(l));
  }
  return all;
}

}  // namespace linescope
