// The words of the control segment: both ends use these. Not for users.
#pragma once

#include <cstddef>
#include <cstdint>

#include "ipc/control_layout.h"
#include "ipc/shared_words.hpp"

namespace linescope {

inline constexpr int kStateBits = 8;
inline constexpr std::uint64_t kTicketMask =
    (std::uint64_t{1} << 50) - 1;  ///< leaves room for state and slot

constexpr std::uint64_t slot_word(std::uint64_t ticket, ls_slot_state state) {
  return ticket << kStateBits | state;
}
constexpr std::uint64_t ticket_of_word(std::uint64_t word) {
  return word >> kStateBits;
}
constexpr std::uint32_t state_of_word(std::uint64_t word) {
  return static_cast<std::uint32_t>(word & 0xffU);
}

/// Commands are named by ticket and slot, so that a slot that was used again is not mistaken.
constexpr std::uint64_t command_id(std::size_t slot, std::uint64_t ticket) {
  return ticket << 6 | slot;
}
constexpr std::size_t slot_of(std::uint64_t id) {
  return static_cast<std::size_t>(id % LS_CONTROL_SLOTS);
}
constexpr std::uint64_t ticket_of(std::uint64_t id) {
  return id >> 6;
}
static_assert(LS_CONTROL_SLOTS == 1 << 6);

/// Compare-and-swap; false when somebody else was faster.
inline bool change(ls_slot& slot, std::uint64_t from, std::uint64_t to) noexcept {
  return __atomic_compare_exchange_n(&slot.word, &from, to, false, __ATOMIC_ACQ_REL, __ATOMIC_ACQUIRE);
}

inline std::uint64_t request_checksum(const ls_request& request, std::uint64_t ticket) noexcept {
  shared::Checksum sum;
  sum.add(ticket);
  for (std::size_t i = 0; i < offsetof(ls_request, checksum) / 8; ++i) {
    std::uint64_t word;
    std::memcpy(&word, reinterpret_cast<const std::byte*>(&request) + i * 8, 8);
    sum.add(word);
  }
  return sum.value();
}

}  // namespace linescope
