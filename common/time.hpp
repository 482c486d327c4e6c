// The one clock of the system: CLOCK_MONOTONIC, in nanoseconds, the same for all processes of the machine.
#pragma once

#include <cstdint>

namespace linescope {

/// A point in time on CLOCK_MONOTONIC, or a difference of two; nanoseconds.
using Nanoseconds = std::int64_t;

inline constexpr Nanoseconds kMicrosecond = 1'000;
inline constexpr Nanoseconds kMillisecond = 1'000'000;
inline constexpr Nanoseconds kSecond = 1'000'000'000;

/// Now. Never fails, never goes back; safe from any thread.
Nanoseconds monotonic_now() noexcept;

constexpr double seconds_from(Nanoseconds t) {
  return static_cast<double>(t) * 1e-9;
}
constexpr double milliseconds_from(Nanoseconds t) {
  return static_cast<double>(t) * 1e-6;
}
constexpr Nanoseconds nanoseconds_from_seconds(double s) {
  return static_cast<Nanoseconds>(s * 1e9);
}

}  // namespace linescope
