// Noticing news and sleeping until there are some.
#include <algorithm>

#include "ipc/control_layout.h"
#include "ipc/futex.hpp"
#include "ipc/segment_reader_parts.hpp"

namespace linescope {
namespace {

constexpr Nanoseconds kLookAtLeastEvery = 50 * kMillisecond;
constexpr Nanoseconds kPollWithoutWakeUps = 2 * kMillisecond;
constexpr Nanoseconds kRungAhead = 20'000;
constexpr std::array kTopics{Topic::lines, Topic::poses, Topic::pictures, Topic::status};

bool includes(Topic topics, Topic one) {
  return (static_cast<std::uint32_t>(topics) & static_cast<std::uint32_t>(one)) != 0;
}

}  // namespace

/// A number that changes with everything published under a topic.
std::uint64_t SegmentReader::Parts::state_of(Topic topic) const {
  const auto head = [this](ls_section_kind kind, std::uint32_t which = 0) {
    return shared::load(ring(kind, which).head());
  };
  std::uint64_t sum = 0;
  switch (topic) {
    case Topic::lines:
      return shared::load(header().published);
    case Topic::pictures:
      return head(LS_SECTION_PICTURES);
    case Topic::poses:
      for (std::uint32_t s = 0; s < LS_STATIONS; ++s) sum += head(LS_SECTION_POSES, s);
      return sum;
    default:
      break;
  }
  for (std::uint32_t s = 0; s < LS_STATIONS; ++s) sum += head(LS_SECTION_SENSORS, s);
  for (std::uint32_t t = 0; t < LS_TEXTS; ++t) sum += head(LS_SECTION_TEXTS, t);
  sum += head(LS_SECTION_STATE) + head(LS_SECTION_CAMERA);
  const std::uint64_t flags =
      shared::load(header().scanning) | (std::uint64_t{shared::load(header().full)} << 1);
  return (sum << 8) ^ (flags & 0xffU);
}

bool SegmentReader::news(Topic topics) {
  bool any = false;
  for (std::size_t i = 0; i < kTopics.size(); ++i) {
    if (!includes(topics, kTopics[i])) continue;
    const std::uint64_t now = parts_->state_of(kTopics[i]);
    any = any || now != parts_->seen[i];
    parts_->seen[i] = now;
  }
  return any;
}

/// The writer rings before it copies a line: what it rang for is a matter of microseconds.
bool SegmentReader::news_soon(Topic topics) {
  for (const Nanoseconds end = monotonic_now() + kRungAhead; monotonic_now() < end;) {
    if (news(topics)) return true;
  }
  return false;
}

bool SegmentReader::wait(Topic topics, Nanoseconds timeout) {
  Parts& p = *parts_;
  const Nanoseconds start = monotonic_now();
  const Nanoseconds deadline = start + std::max<Nanoseconds>(timeout, 0);
  const auto bits = static_cast<std::uint32_t>(topics);
  bool was_live = true, woken = false;
  for (Nanoseconds now = start;; now = monotonic_now()) {
    // Looked at first, as what is new is read from the mapping. A wake-up comes through the mapping: it is
    // whole.
    if (!woken && !p.intact()) return false;
    const std::uint32_t before = shared::load(p.header().news);
    if (news(topics) || (woken && news_soon(topics))) return true;
    const Life life = p.examine(now);
    const bool live = life == Life::live;
    if (life == Life::damaged || (was_live && !live && now != start) || now >= deadline) return false;
    was_live = live;
    Nanoseconds until = std::min(deadline, now + kLookAtLeastEvery);
    if (live) until = std::min(until, shared::load(p.header().heartbeat_ns) + kDeadAfter);
    if (p.control) {
      __atomic_fetch_or(&reinterpret_cast<ls_control*>(p.control->data())->sleepers, bits, __ATOMIC_SEQ_CST);
    } else {
      until = std::min(until, now + kPollWithoutWakeUps);
    }
    woken = shared::futex_wait(p.header().news, before, until, bits);
  }
}

}  // namespace linescope
