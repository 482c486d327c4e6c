// Sleeping until a word of a shared mapping changes. Also from a read-only mapping, which FUTEX_WAIT allows.
#pragma once

#include <cstdint>

#include "common/time.hpp"

namespace linescope::shared {

/// Sleeps while `word` holds `expected`, until woken with one of `bits` or until `deadline`
/// (CLOCK_MONOTONIC). May return early without a reason. True when it was woken.
bool futex_wait(const std::uint32_t& word, std::uint32_t expected, Nanoseconds deadline,
                std::uint32_t bits) noexcept;

/// Wakes everybody who sleeps on `word` for one of `bits`.
void futex_wake(std::uint32_t& word, std::uint32_t bits) noexcept;

inline constexpr std::uint32_t kAllBits = 0xffffffffU;

}  // namespace linescope::shared
