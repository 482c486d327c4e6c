#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstring>

#include "ipc/control.hpp"
#include "ipc/control_slot.hpp"
#include "ipc/futex.hpp"
#include "ipc/segment_reader.hpp"
#include "ipc/shared_object.hpp"

namespace linescope {

struct ControlClient::Parts {
  explicit Parts(SharedObject mapped) : object(std::move(mapped)) {}
  ls_control& control() const { return *reinterpret_cast<ls_control*>(object.data()); }
  bool intact() const { return object.facts().bytes >= sizeof(ls_control); }

  SharedObject object;
};

ControlClient::ControlClient(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
ControlClient::~ControlClient() = default;
ControlClient::ControlClient(ControlClient&&) noexcept = default;
ControlClient& ControlClient::operator=(ControlClient&&) noexcept = default;

Result<ControlClient> ControlClient::open(const SegmentReader& reader) {
  const SegmentIdentity& who = reader.identity();
  auto object = SharedObject::open(who.control_name, Access::read_write);
  if (!object) return tl::unexpected(object.error());
  if (auto ok = object->map(sizeof(ls_control), true); !ok) return tl::unexpected(ok.error());
  auto parts = std::make_unique<Parts>(std::move(*object));
  const ls_control& c = parts->control();
  if (shared::load(c.magic) != LS_CONTROL_MAGIC || c.version != LS_CONTROL_VERSION ||
      c.slot_count != LS_CONTROL_SLOTS) {
    return fail(ErrorCode::mismatch,
                fmt::format("/dev/shm/{} is no control segment of this layout version", who.control_name));
  }
  if (c.session_id != who.session_id) {
    return fail(ErrorCode::gone, fmt::format("the control segment {} belongs to another daemon: attach again",
                                             who.control_name));
  }
  return ControlClient(std::move(parts));
}

namespace {

Result<ls_request> request_of(const Command& command, std::uint64_t ticket) {
  ls_request r{};
  if (command.text.size() > sizeof r.text - 1) {
    return fail(ErrorCode::usage, fmt::format("the text of a command may have {} bytes, not {}",
                                              sizeof r.text - 1, command.text.size()));
  }
  if (!std::isfinite(command.number))
    return fail(ErrorCode::invalid, "the number of a command must be finite");
  r.command = static_cast<std::uint32_t>(command.kind);
  r.sender_pid = static_cast<std::uint32_t>(::getpid());
  r.sent_ns = monotonic_now();
  r.number = command.number;
  r.text_bytes = static_cast<std::uint32_t>(command.text.size());
  std::memcpy(r.text, command.text.data(), command.text.size());
  r.checksum = request_checksum(r, ticket);
  return r;
}

/// The first free slot, claimed; nullptr when there is none.
ls_slot* claim(ls_control& control, std::uint64_t ticket) {
  for (ls_slot& slot : control.slots) {
    std::uint64_t word = shared::load(slot.word);
    if (state_of_word(word) == LS_SLOT_FREE && change(slot, word, slot_word(ticket, LS_SLOT_CLAIMED)))
      return &slot;
  }
  return nullptr;
}

void ring_the_bell(ls_control& control) {
  __atomic_fetch_add(&control.bell, 1U, __ATOMIC_SEQ_CST);
  if (__atomic_load_n(&control.listens, __ATOMIC_SEQ_CST) != 0)
    shared::futex_wake(control.bell, shared::kAllBits);
}

}  // namespace

Result<CommandId> ControlClient::send(const Command& command) {
  if (!parts_->intact())
    return fail(ErrorCode::gone, "the control segment was cut short: restart the daemon");
  ls_control& control = parts_->control();
  const std::uint64_t ticket =
      __atomic_fetch_add(&control.next_ticket, std::uint64_t{1}, __ATOMIC_RELAXED) & kTicketMask;
  auto request = request_of(command, ticket);
  if (!request) return tl::unexpected(request.error());
  ls_slot* slot = claim(control, ticket);
  if (slot == nullptr) {
    return fail(ErrorCode::full,
                fmt::format("{} commands are waiting already: the daemon does not answer", LS_CONTROL_SLOTS));
  }
  shared::put(slot->request, *request);
  if (!change(*slot, slot_word(ticket, LS_SLOT_CLAIMED), slot_word(ticket, LS_SLOT_SENT))) {
    return fail(ErrorCode::timeout, "sending took so long that the daemon gave the slot away: send again");
  }
  ring_the_bell(control);
  return command_id(static_cast<std::size_t>(slot - control.slots), ticket);
}

namespace {

CommandAnswer read_reply(const ls_slot& slot) {
  ls_reply r;
  shared::get(r, slot.reply);
  CommandAnswer answer;
  answer.kind = r.answer == LS_ANSWER_DONE      ? AnswerKind::done
                : r.answer == LS_ANSWER_REFUSED ? AnswerKind::refused
                                                : AnswerKind::unknown;
  answer.text.assign(r.text, strnlen(r.text, sizeof r.text));
  return answer;
}

}  // namespace

CommandAnswer ControlClient::answer(CommandId id) {
  const CommandAnswer lost{AnswerKind::lost, "the daemon does not hold this command any more"};
  if (id == 0 || !parts_->intact()) return lost;
  ls_slot& slot = parts_->control().slots[slot_of(id)];
  const std::uint64_t word = shared::load(slot.word);
  if (ticket_of_word(word) != ticket_of(id)) return lost;
  switch (state_of_word(word)) {
    case LS_SLOT_SENT:
    case LS_SLOT_TAKEN:
      return {AnswerKind::pending, {}};
    case LS_SLOT_ANSWERED:
      break;
    default:
      return lost;
  }
  CommandAnswer found = read_reply(slot);
  return change(slot, word, slot_word(ticket_of(id), LS_SLOT_FREE)) ? found : lost;
}

Result<CommandAnswer> ControlClient::await(CommandId id, Nanoseconds timeout) {
  const Nanoseconds deadline = monotonic_now() + timeout;
  while (true) {
    const ls_slot& slot = parts_->control().slots[slot_of(id)];
    const std::uint32_t before = parts_->intact() ? shared::load(slot.answered) : 0;
    const CommandAnswer found = answer(id);
    if (found.kind != AnswerKind::pending) return found;
    if (monotonic_now() >= deadline) {
      return fail(ErrorCode::timeout,
                  fmt::format("the daemon has not answered within {:.1f} s", seconds_from(timeout)));
    }
    shared::futex_wait(slot.answered, before, std::min(deadline, monotonic_now() + 50 * kMillisecond),
                       shared::kAllBits);
  }
}

}  // namespace linescope
