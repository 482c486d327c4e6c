// Inside of SegmentReader. Not for users.
#pragma once

#include <array>
#include <optional>

#include "ipc/segment_plan.hpp"
#include "ipc/segment_reader.hpp"
#include "ipc/shared_object.hpp"
#include "ipc/shared_ring.hpp"

namespace linescope {

struct SegmentReader::Parts {
  Parts(SharedObject mapped, const SegmentPlan& checked, const SegmentIdentity& who, std::uint32_t samples)
      : segment(std::move(mapped)), plan(checked), identity(who), picture_samples(samples) {}

  const std::byte* base() const { return segment.data(); }
  const ls_header& header() const { return *reinterpret_cast<const ls_header*>(base()); }
  shared::RingOut ring(ls_section_kind kind, std::uint32_t which = 0) const {
    return {base(), plan[kind], which};
  }
  const std::byte* element(ls_section_kind kind, std::uint64_t index) const {
    return base() + plan[kind].offset + std::size_t{plan[kind].record_bytes} * index;
  }

  /// Whether the mapping is still as long as it was: whoever owns the object could cut it short. The check
  /// comes before the access, so an owner who cuts in between still ends this process; only he can.
  bool intact() const { return segment.facts().bytes >= segment.size(); }

  Life examine(Nanoseconds now) const;
  std::uint64_t state_of(Topic topic) const;

  SharedObject segment;
  SegmentPlan plan;
  SegmentIdentity identity;
  std::uint32_t picture_samples;
  std::optional<SharedObject> control;  ///< for wake-ups only

  std::array<std::uint64_t, 4> seen{};  ///< per topic, what the last wait or news returned for
  mutable Nanoseconds name_checked = 0;
  mutable bool has_name = true;
  mutable bool name_is_gone = false;
};

/// The newest record of a ring, whole. `out` begins with the structure of the layout.
template <class Record>
ReadOutcome read_latest(const shared::RingOut& ring, Record& out) {
  for (int i = 0; i < shared::kTries; ++i) {
    const std::uint64_t head = shared::load(ring.head());
    if (head == 0) return ReadOutcome::nothing;
    shared::get(out, shared::RingOut::as<Record>(ring.place(head - 1)));
    if (!ring.intact(head - 1)) continue;
    return out.index == head - 1 ? ReadOutcome::ok : ReadOutcome::corrupt;
  }
  return ReadOutcome::overtaken;
}

template <std::size_t N>
std::string text_of(const char (&field)[N]) {
  return {field, strnlen(field, N)};
}

/// A state as number from the segment; impossible numbers count as the worst state.
ToolState tool_state(std::uint32_t number);

}  // namespace linescope
