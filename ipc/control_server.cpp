#include <algorithm>
#include <array>
#include <vector>

#include "ipc/control.hpp"
#include "ipc/control_slot.hpp"
#include "ipc/futex.hpp"
#include "ipc/segment_writer_parts.hpp"

namespace linescope {
namespace {

constexpr Nanoseconds kSenderMayTake = kSecond;
constexpr Nanoseconds kAnswerIsKept = 10 * kSecond;

/// A state and how long we have been seeing it. Times a sender wrote are not trusted for that.
struct Sighting {
  std::uint64_t word = 0;
  Nanoseconds since = 0;
};

}  // namespace

struct ControlServer::Parts {
  explicit Parts(SegmentWriter& w, ls_control& c) : writer(w), control(c) {}

  void reclaim(Nanoseconds now);
  void reclaim_one(std::size_t index, Nanoseconds now);
  std::vector<std::size_t>& waiting();
  void carry_out(std::size_t slot, Nanoseconds now, const Handler& handler);
  CommandAnswer handle(const ls_request& request, std::uint64_t id, const Handler& handler);
  void reply(ls_slot& slot, std::uint64_t ticket, const CommandAnswer& answer);

  SegmentWriter& writer;
  ls_control& control;
  std::array<Sighting, LS_CONTROL_SLOTS> sightings{};
  std::vector<std::size_t> order;
  std::array<std::uint64_t, LS_CONTROL_SLOTS>
      postponed{};  ///< ticket of the command a late answer is owed to
};

ControlServer::ControlServer(SegmentWriter& writer)
    : parts_(std::make_unique<Parts>(writer, writer.parts_->mailbox())) {
  parts_->order.reserve(LS_CONTROL_SLOTS);
}
ControlServer::~ControlServer() = default;

/// Slots whose sender died while writing, and answers nobody fetched, become free again.
void ControlServer::Parts::reclaim_one(std::size_t index, Nanoseconds now) {
  ls_slot& slot = control.slots[index];
  Sighting& sighting = sightings[index];
  const std::uint64_t word = shared::load(slot.word);
  if (word != sighting.word) sighting = {word, now};
  const Nanoseconds age = now - sighting.since;
  const std::uint32_t state = state_of_word(word);
  const std::uint64_t free = slot_word(ticket_of_word(word), LS_SLOT_FREE);
  if (state == LS_SLOT_CLAIMED && age >= kSenderMayTake) {
    if (change(slot, word, free)) writer.count(Counter::commands_sender_died);
  } else if (state == LS_SLOT_ANSWERED && age >= kAnswerIsKept) {
    if (change(slot, word, free)) writer.count(Counter::answers_not_collected);
  } else if (state > LS_SLOT_ANSWERED ||
             (state == LS_SLOT_TAKEN && postponed[index] != ticket_of_word(word))) {
    // States only a broken sender writes: here nothing is in work but what is postponed.
    if (change(slot, word, free)) writer.count(Counter::commands_damaged);
  }
}

void ControlServer::Parts::reclaim(Nanoseconds now) {
  for (std::size_t i = 0; i < LS_CONTROL_SLOTS; ++i) reclaim_one(i, now);
}

/// Slots that hold a complete request, in the order of sending.
std::vector<std::size_t>& ControlServer::Parts::waiting() {
  std::array<std::uint64_t, LS_CONTROL_SLOTS> words{};
  order.clear();
  for (std::size_t i = 0; i < LS_CONTROL_SLOTS; ++i) {
    words[i] = shared::load(control.slots[i].word);
    if (state_of_word(words[i]) == LS_SLOT_SENT) order.push_back(i);
  }
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return words[a] < words[b]; });
  return order;
}

CommandAnswer ControlServer::Parts::handle(const ls_request& request, std::uint64_t id,
                                           const Handler& handler) {
  if (request.checksum != request_checksum(request, ticket_of(id)) ||
      request.text_bytes >= sizeof request.text) {
    writer.count(Counter::commands_damaged);
    return {AnswerKind::refused, "the command was damaged on its way: send it again"};
  }
  if (request.command < LS_COMMAND_START || request.command > LS_COMMAND_SHUT_DOWN) {
    return {AnswerKind::unknown, "this daemon does not know that command"};
  }
  ReceivedCommand command;
  command.kind = static_cast<CommandKind>(request.command);
  command.number = request.number;
  command.text.assign(request.text, request.text_bytes);
  command.id = id;
  command.sender_pid = request.sender_pid;
  command.sent = request.sent_ns;
  return handler(command);
}

void ControlServer::Parts::carry_out(std::size_t index, Nanoseconds now, const Handler& handler) {
  ls_slot& slot = control.slots[index];
  const std::uint64_t word = shared::load(slot.word);
  const std::uint64_t ticket = ticket_of_word(word);
  if (state_of_word(word) != LS_SLOT_SENT || !change(slot, word, slot_word(ticket, LS_SLOT_TAKEN))) return;
  writer.count(Counter::commands_received);
  ls_request request;
  shared::get(request, slot.request);
  const CommandAnswer answer = handle(request, command_id(index, ticket), handler);
  if (answer.kind == AnswerKind::pending) {
    postponed[index] = ticket;
    return;
  }
  writer.record_latency(LatencyStage::command,
                        std::clamp<Nanoseconds>(now - request.sent_ns, 0, 3600 * kSecond));
  reply(slot, ticket, answer);
}

void ControlServer::Parts::reply(ls_slot& slot, std::uint64_t ticket, const CommandAnswer& answer) {
  ls_reply r{};
  const bool done = answer.kind == AnswerKind::done, refused = answer.kind == AnswerKind::refused;
  r.answer = done ? LS_ANSWER_DONE : refused ? LS_ANSWER_REFUSED : LS_ANSWER_UNKNOWN;
  r.text_bytes = static_cast<std::uint32_t>(answer.text.size());
  r.answered_ns = monotonic_now();
  set_text(r.text, answer.text);
  r.text_bytes = static_cast<std::uint32_t>(strnlen(r.text, sizeof r.text));
  writer.count(done      ? Counter::commands_done
               : refused ? Counter::commands_refused
                         : Counter::commands_unknown);
  shared::put(slot.reply, r);
  if (!change(slot, slot_word(ticket, LS_SLOT_TAKEN), slot_word(ticket, LS_SLOT_ANSWERED))) return;
  __atomic_fetch_add(&slot.answered, 1U, __ATOMIC_SEQ_CST);
  shared::futex_wake(slot.answered, shared::kAllBits);
}

int ControlServer::poll(Nanoseconds now, const Handler& handler) {
  parts_->reclaim(now);
  const std::vector<std::size_t>& waiting = parts_->waiting();
  for (const std::size_t slot : waiting) parts_->carry_out(slot, now, handler);
  return static_cast<int>(waiting.size());
}

bool ControlServer::wait(Nanoseconds timeout) {
  ls_control& control = parts_->control;
  const Nanoseconds deadline = monotonic_now() + timeout;
  const std::uint32_t bell = shared::load(control.bell);
  __atomic_store_n(&control.listens, 1U, __ATOMIC_SEQ_CST);
  while (parts_->waiting().empty() && monotonic_now() < deadline) {
    if (__atomic_load_n(&control.bell, __ATOMIC_SEQ_CST) != bell) break;
    shared::futex_wait(control.bell, bell, deadline, shared::kAllBits);
  }
  shared::store(control.listens, 0U);
  return !parts_->waiting().empty();
}

void ControlServer::answer(CommandId id, const CommandAnswer& answer) {
  if (parts_->postponed[slot_of(id)] != ticket_of(id) || id == 0) return;
  parts_->postponed[slot_of(id)] = 0;
  parts_->reply(parts_->control.slots[slot_of(id)], ticket_of(id), answer);
}

}  // namespace linescope
