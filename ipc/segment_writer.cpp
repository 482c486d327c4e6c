#include "ipc/segment_writer.hpp"

#include <fmt/format.h>
#include <sys/random.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <ctime>
#include <utility>

#include "ipc/process_identity.hpp"
#include "ipc/segment_claim.hpp"
#include "ipc/segment_writer_parts.hpp"

namespace linescope {
namespace {

using shared::RingWriter;

std::uint64_t random_session() {
  std::uint64_t id = 0;
  if (::getrandom(&id, sizeof id, 0) != sizeof id)
    id = static_cast<std::uint64_t>(monotonic_now()) ^ (std::uint64_t(::getpid()) << 40);
  return id == 0 ? 1 : id;
}

Nanoseconds utc_now() {
  timespec t{};
  clock_gettime(CLOCK_REALTIME, &t);
  return static_cast<Nanoseconds>(t.tv_sec) * kSecond + t.tv_nsec;
}

template <std::size_t... I>
RingWriters<sizeof...(I)> rings(std::byte* segment, const ls_section& section, std::index_sequence<I...>) {
  return {RingWriter(segment, section, I)...};
}

void fill_header(ls_header& header, const SegmentOptions& options, const SegmentPlan& plan,
                 std::uint64_t session_id) {
  shared::store(header.magic, LS_MAGIC_CREATING);
  const ProcessIdentity self = this_process();
  shared::store(header.writer_pid, self.pid);
  shared::store(header.writer_start_ticks, self.start_ticks);
  shared::store(header.pid_namespace, self.pid_namespace);
  header.layout_major = LS_LAYOUT_MAJOR;
  header.layout_minor = LS_LAYOUT_MINOR;
  header.endian_mark = LS_ENDIAN_MARK;
  header.header_bytes = LS_HEADER_BYTES;
  header.total_bytes = plan.total_bytes;
  header.session_id = session_id;
  header.started_ns = monotonic_now();
  header.started_utc_ns = utc_now();
  header.writer_uid = ::geteuid();
  header.counter_count = LS_COUNTER_COUNT;
  header.latency_count = LS_LATENCY_COUNT;
  header.picture_samples = options.picture_samples;
  set_text(header.program, options.program);
  set_text(header.control_name, control_name(options.name));
  header.section_count = kSectionKinds - 1;
  std::copy(plan.sections.begin() + 1, plan.sections.end(), header.sections);
}

void fill_names(ls_counter* counters, ls_latency* latencies) {
  for (std::uint32_t i = 0; i < LS_COUNTER_COUNT; ++i)
    set_text(counters[i].name, name(static_cast<Counter>(i)));
  for (std::uint32_t i = 0; i < LS_LATENCY_COUNT; ++i)
    set_text(latencies[i].name, name(static_cast<LatencyStage>(i)));
}

/// A control segment without its main segment is a leftover; the main one, which we hold by now, is the only
/// right to it.
Result<SharedObject> make_control(const SegmentOptions& options, std::uint64_t session_id) {
  const std::string name = control_name(options.name);
  if (auto leftover = SharedObject::open(name, Access::read_write)) leftover->remove_name();
  auto made = SharedObject::create(name, sizeof(ls_control), options.group, 0660);
  if (!made) return made;
  auto& control = *reinterpret_cast<ls_control*>(made->data());
  control.version = LS_CONTROL_VERSION;
  control.slot_count = LS_CONTROL_SLOTS;
  control.total_bytes = sizeof(ls_control);
  control.session_id = session_id;
  control.next_ticket = 1;
  shared::store(control.magic, LS_CONTROL_MAGIC);
  return made;
}

}  // namespace

SegmentWriter::Parts::Parts(const SegmentOptions& wanted, SharedObject main, SharedObject control,
                            const SegmentPlan& planned, std::uint64_t session)
    : options(wanted),
      segment(std::move(main)),
      control_segment(std::move(control)),
      plan(planned),
      session_id(session),
      announcer(header().news, mailbox().sleepers),
      states(segment.data(), plan[LS_SECTION_STATE]),
      texts(rings(segment.data(), plan[LS_SECTION_TEXTS], std::make_index_sequence<LS_TEXTS>{})),
      poses(rings(segment.data(), plan[LS_SECTION_POSES], std::make_index_sequence<LS_STATIONS>{})),
      sensors(rings(segment.data(), plan[LS_SECTION_SENSORS], std::make_index_sequence<LS_STATIONS>{})),
      scans(segment.data(), plan[LS_SECTION_SCANS]),
      pictures(segment.data(), plan[LS_SECTION_PICTURES]),
      frames(segment.data(), plan[LS_SECTION_FRAMES]),
      cameras(segment.data(), plan[LS_SECTION_CAMERA]) {}

ls_counter* SegmentWriter::Parts::counters() const {
  return reinterpret_cast<ls_counter*>(segment.data() + plan[LS_SECTION_COUNTERS].offset);
}

ls_latency* SegmentWriter::Parts::latencies() const {
  return reinterpret_cast<ls_latency*>(segment.data() + plan[LS_SECTION_LATENCIES].offset);
}

void set_text(char* field, std::size_t size, std::string_view text) {
  std::size_t length = std::min(size - 1, text.size());
  const auto continues = [&](std::size_t i) {
    return (static_cast<unsigned char>(text[i]) & 0xC0U) == 0x80U;
  };
  if (length < text.size()) {
    while (length > 0 && continues(length)) --length;
  }
  std::memset(field, 0, size);
  std::copy_n(text.data(), length, field);
}

SegmentWriter::SegmentWriter(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
SegmentWriter::SegmentWriter(SegmentWriter&&) noexcept = default;
SegmentWriter& SegmentWriter::operator=(SegmentWriter&&) noexcept = default;

Result<SegmentWriter> SegmentWriter::create(const SegmentOptions& options) {
  if (auto ok = validate(options); !ok) return tl::unexpected(ok.error());
  const SegmentPlan plan = plan_segment(options);
  const std::uint64_t session_id = random_session();
  auto main = claim_segment(options, plan.total_bytes, session_id);
  if (!main) return tl::unexpected(main.error());
  fill_header(*reinterpret_cast<ls_header*>(main->data()), options, plan, session_id);
  auto control = make_control(options, session_id);
  if (!control) {
    main->remove_name();
    return tl::unexpected(control.error());
  }
  SegmentWriter writer(
      std::make_unique<Parts>(options, std::move(*main), std::move(*control), plan, session_id));
  fill_names(writer.parts_->counters(), writer.parts_->latencies());
  writer.set_state(DaemonState::starting, "");
  if (auto ok = writer.heartbeat(monotonic_now()); !ok) return tl::unexpected(ok.error());
  shared::store(writer.parts_->header().magic, std::uint64_t{LS_MAGIC});
  return writer;
}

SegmentWriter::~SegmentWriter() {
  if (!parts_) return;
  shared::store(parts_->header().closed, 1U);
  parts_->announcer.wake_all();
  parts_->control_segment.remove_name();
  parts_->segment.remove_name();
}

Result<void> SegmentWriter::heartbeat(Nanoseconds now) {
  Parts& p = *parts_;
  if (p.last_beat != 0 && now - p.last_beat > kHeartbeatAtLeastEvery) count(Counter::heartbeats_late);
  p.last_beat = now;
  shared::store(p.header().heartbeat_ns, now);
  shared::store(p.header().heartbeat_count, ++p.beats);
  if (p.segment.owns_its_name()) return {};
  return fail(ErrorCode::gone,
              fmt::format("segment {} was {}: this daemon has lost its readers and must end", p.options.name,
                          shared::load(p.header().replaced_by) != 0 ? "taken over by another daemon"
                                                                    : "removed by somebody"));
}

void SegmentWriter::set_state(DaemonState state, std::string_view reason) {
  ls_state_record record{};
  record.since_ns = monotonic_now();
  record.state = static_cast<std::uint32_t>(state);
  set_text(record.reason, reason);
  parts_->states.publish(record);
  parts_->announcer.announce(Topic::status);
}

namespace {

void put_text(RingWriter& ring, std::string_view text) {
  ls_text_record record{};
  record.index = ring.next();
  record.time_ns = monotonic_now();
  record.text_bytes = static_cast<std::uint32_t>(text.size());
  std::byte* at = ring.place();
  shared::put(*reinterpret_cast<ls_text_record*>(at), record);
  at += sizeof record;
  const std::size_t whole = text.size() / 8;
  shared::copy_in(at, text.data(), whole);
  if (text.size() % 8 != 0) {
    std::uint64_t tail = 0;
    std::memcpy(&tail, text.data() + whole * 8, text.size() % 8);
    shared::copy_in(at + whole * 8, &tail, 1);
  }
  ring.publish();
}

}  // namespace

bool SegmentWriter::publish_configuration(std::string_view toml) {
  if (toml.size() > parts_->options.text_bytes) return count(Counter::texts_too_long), false;
  put_text(parts_->texts[LS_TEXT_CONFIGURATION], toml);
  parts_->announcer.announce(Topic::status);
  return true;
}

bool SegmentWriter::publish_calibration(std::string_view yaml) {
  if (yaml.size() > parts_->options.text_bytes) return count(Counter::texts_too_long), false;
  put_text(parts_->texts[LS_TEXT_CALIBRATION], yaml);
  parts_->announcer.announce(Topic::status);
  return true;
}

void SegmentWriter::count(Counter counter, std::uint64_t n) {
  shared::add(parts_->counters()[static_cast<std::uint32_t>(counter)].value, n);
}

std::uint64_t SegmentWriter::counted(Counter counter) const {
  return shared::load(parts_->counters()[static_cast<std::uint32_t>(counter)].value);
}

std::uint64_t SegmentWriter::session_id() const {
  return parts_->session_id;
}
const std::string& SegmentWriter::name() const {
  return parts_->options.name;
}

}  // namespace linescope
