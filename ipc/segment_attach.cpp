// Attaching: every way in which an object of that name is not a segment to be trusted, in words.
#include <fmt/format.h>
#include <unistd.h>

#include "ipc/control_layout.h"
#include "ipc/process_identity.hpp"
#include "ipc/segment_reader_parts.hpp"

namespace linescope {
namespace {

Result<void> check_owner(const SharedObject& object, const AttachOptions& options) {
  const ObjectFacts facts = object.facts();
  if (options.other_owner || facts.owner == ::geteuid() || facts.owner == 0) return {};
  return fail(
      ErrorCode::permission,
      fmt::format(
          "segment {} belongs to {}: somebody else's data is only shown when asked for (--other-owner)",
          options.name, user_name(facts.owner)));
}

Result<void> check_magic(const ls_header& h, const std::string& name) {
  if (h.magic == LS_MAGIC_CREATING || h.magic == 0) {
    return fail(ErrorCode::busy, fmt::format("segment {} is just being set up: try again", name));
  }
  if (h.magic == __builtin_bswap64(LS_MAGIC) || (h.magic == LS_MAGIC && h.endian_mark != LS_ENDIAN_MARK)) {
    return fail(ErrorCode::mismatch,
                fmt::format("segment {} has another byte order than this machine", name));
  }
  if (h.magic != LS_MAGIC) {
    return fail(ErrorCode::mismatch,
                fmt::format("/dev/shm/{} is no linescope segment: choose another name or remove it", name));
  }
  if (h.layout_major != LS_LAYOUT_MAJOR) {
    return fail(ErrorCode::mismatch, fmt::format("segment {} has layout version {}.{}, this program reads "
                                                 "{}.x: use viewer and daemon of the same release",
                                                 name, h.layout_major, h.layout_minor, LS_LAYOUT_MAJOR));
  }
  return {};
}

Result<void> check_size(const ls_header& h, std::uint64_t mapped, const std::string& name) {
  if (h.total_bytes == mapped && h.header_bytes == LS_HEADER_BYTES && h.session_id != 0) return {};
  return fail(ErrorCode::unreadable, fmt::format("segment {} is {} bytes long, but its header says {}: it is "
                                                 "truncated or damaged; restart the daemon",
                                                 name, mapped, h.total_bytes));
}

SegmentIdentity identity_of(const ls_header& h, const SegmentPlan& plan, const std::string& name) {
  SegmentIdentity id;
  id.name = name;
  id.program = text_of(h.program);
  id.control_name = text_of(h.control_name);
  id.session_id = h.session_id;
  id.writer_pid = h.writer_pid;
  id.writer_uid = h.writer_uid;
  id.layout_major = h.layout_major;
  id.layout_minor = h.layout_minor;
  id.started = h.started_ns;
  id.started_utc = h.started_utc_ns;
  id.bytes = plan.total_bytes;
  id.point_capacity = plan[LS_SECTION_POINTS].record_count;
  id.line_capacity = plan[LS_SECTION_LINES].record_count;
  id.pose_history = plan[LS_SECTION_POSES].record_count;
  return id;
}

Result<SharedObject> open_and_map(const AttachOptions& options) {
  auto object = SharedObject::open(options.name, Access::read_only);
  if (!object && object.error().code == ErrorCode::not_found) {
    return fail(
        ErrorCode::not_found,
        fmt::format("there is no segment {}: no linescope daemon of that name is running (linescope-acquire)",
                    options.name));
  }
  if (!object) return object;
  if (auto ok = check_owner(*object, options); !ok) return tl::unexpected(ok.error());
  if (object->facts().bytes == 0) {
    return fail(ErrorCode::busy, fmt::format("segment {} is just being set up: try again", options.name));
  }
  if (auto ok = object->map(sizeof(ls_header), options.prefault); !ok) return tl::unexpected(ok.error());
  return object;
}

/// Only for waking up; whoever may not open it polls.
std::optional<SharedObject> open_control(const SegmentIdentity& identity) {
  auto object = SharedObject::open(identity.control_name, Access::read_write);
  if (!object || !object->map(sizeof(ls_control), true)) return std::nullopt;
  const auto& control = *reinterpret_cast<const ls_control*>(object->data());
  if (shared::load(control.magic) != LS_CONTROL_MAGIC ||
      shared::load(control.session_id) != identity.session_id)
    return std::nullopt;
  return std::move(*object);
}

}  // namespace

Result<SegmentReader> SegmentReader::attach(const AttachOptions& options) {
  auto object = open_and_map(options);
  if (!object) return tl::unexpected(object.error());
  ls_header header;
  shared::get(header, *reinterpret_cast<const ls_header*>(object->data()));
  if (auto ok = check_magic(header, options.name); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_size(header, object->size(), options.name); !ok) return tl::unexpected(ok.error());
  auto plan = checked_plan(header, object->size());
  if (!plan) {
    return fail(plan.error().code, fmt::format("segment {}: {}", options.name, plan.error().message));
  }
  auto parts = std::make_unique<Parts>(std::move(*object), *plan, identity_of(header, *plan, options.name),
                                       header.picture_samples);
  if (options.wake_ups) parts->control = open_control(parts->identity);
  return SegmentReader(std::move(parts));
}

}  // namespace linescope
