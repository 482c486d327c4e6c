#include "ipc/segment_claim.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "common/time.hpp"
#include "ipc/futex.hpp"
#include "ipc/process_identity.hpp"
#include "ipc/segment_layout.h"
#include "ipc/shared_words.hpp"

namespace linescope {
namespace {

constexpr Nanoseconds kDoubtAtMost = kSecond;
constexpr useconds_t kLookEvery_us = 5'000;
constexpr int kRounds = 20;

/// What the holder of the name turned out to be.
enum class Holder { dead, alive, foreign, vanished };

std::uint64_t magic_of(const ls_header& header) {
  return shared::load(header.magic);
}

bool all_zero(const ls_header& header) {
  const auto* bytes = reinterpret_cast<const std::byte*>(&header);
  return std::all_of(bytes, bytes + sizeof header, [](std::byte b) { return b == std::byte{0}; });
}

/// Ours, being set up by us, or left behind in the first microseconds of that.
bool looks_like_ours(const ls_header& header) {
  const std::uint64_t magic = magic_of(header);
  return magic == LS_MAGIC || magic == LS_MAGIC_CREATING || all_zero(header);
}

ProcessIdentity writer_of(const ls_header& header) {
  return {shared::load(header.writer_pid), shared::load(header.writer_start_ticks),
          shared::load(header.pid_namespace)};
}

/// The heartbeat decides: it moves, or it does not for a whole second. The pid only shortens the wait, when
/// it proves the end.
Holder watch(const SharedObject& object, const ls_header& header) {
  const std::uint64_t magic = magic_of(header);
  const std::uint64_t beats = shared::load(header.heartbeat_count);
  for (const Nanoseconds end = monotonic_now() + kDoubtAtMost; monotonic_now() < end;
       ::usleep(kLookEvery_us)) {
    if (!object.owns_its_name()) return Holder::vanished;
    if (shared::load(header.closed) != 0 || provably_ended(writer_of(header))) return Holder::dead;
    if (shared::load(header.heartbeat_count) != beats || magic_of(header) != magic) return Holder::alive;
  }
  return Holder::dead;
}

/// An object too short for a header is one whose creator is at it, or died at it.
Holder watch_short(const SharedObject& object) {
  const std::uint64_t bytes = object.facts().bytes;
  if (bytes != 0) return Holder::foreign;
  for (const Nanoseconds end = monotonic_now() + kDoubtAtMost; monotonic_now() < end;
       ::usleep(kLookEvery_us)) {
    if (!object.owns_its_name()) return Holder::vanished;
    if (object.facts().bytes != bytes) return Holder::vanished;  // look again from the start
  }
  return Holder::dead;
}

void tell_its_readers(ls_header& header, std::uint64_t session_id) {
  shared::store(header.replaced_by, session_id);
  __atomic_fetch_add(&header.news, 1U, __ATOMIC_SEQ_CST);
  shared::futex_wake(header.news, shared::kAllBits);
}

tl::unexpected<Error> somebody_elses(const SharedObject& object, const ObjectFacts& facts) {
  return fail(ErrorCode::permission, fmt::format("segment {} belongs to {}: choose another name (--segment "
                                                 "NAME), or let that user remove /dev/shm/{}",
                                                 object.name(), user_name(facts.owner), object.name()));
}

tl::unexpected<Error> not_ours(const SharedObject& object) {
  return fail(ErrorCode::mismatch, fmt::format("/dev/shm/{} is there, but is no linescope segment: choose "
                                               "another name (--segment NAME) or remove it",
                                               object.name()));
}

/// Removes what a dead writer left, or says why that cannot be. Nothing when the name is free now (or changed
/// hands).
Result<void> clear_the_name(const std::string& name, std::uint64_t session_id) {
  auto found = SharedObject::open(name, Access::read_write);
  if (!found)
    return found.error().code == ErrorCode::not_found ? Result<void>{} : tl::unexpected(found.error());
  const ObjectFacts facts = found->facts();
  if (facts.owner != ::geteuid()) return somebody_elses(*found, facts);
  if (facts.bytes < sizeof(ls_header)) {
    const Holder holder = watch_short(*found);
    if (holder == Holder::foreign) return not_ours(*found);
    if (holder == Holder::dead) found->remove_name();
    return {};
  }
  if (auto ok = found->map(sizeof(ls_header), false); !ok) return ok;
  auto& header = *reinterpret_cast<ls_header*>(found->data());
  if (!looks_like_ours(header)) return not_ours(*found);
  const Holder holder = watch(*found, header);
  if (holder == Holder::alive) {
    return fail(
        ErrorCode::busy,
        fmt::format("a linescope daemon is already running: segment {}, pid {}; stop it or choose another "
                    "name (--segment NAME)",
                    name, shared::load(header.writer_pid)));
  }
  if (holder == Holder::dead) {
    tell_its_readers(header, session_id);
    found->remove_name();
  }
  return {};
}

}  // namespace

Result<SharedObject> claim_segment(const SegmentOptions& options, std::size_t bytes,
                                   std::uint64_t session_id) {
  for (int round = 0; round < kRounds; ++round) {
    auto made = SharedObject::create(options.name, bytes, options.group, 0640);
    if (made || made.error().code != ErrorCode::busy) return made;
    if (auto cleared = clear_the_name(options.name, session_id); !cleared)
      return tl::unexpected(cleared.error());
  }
  return fail(
      ErrorCode::busy,
      fmt::format("segment {} changes hands all the time: are several daemons being started?", options.name));
}

}  // namespace linescope
