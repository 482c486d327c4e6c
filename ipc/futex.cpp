#include "ipc/futex.hpp"

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <climits>
#include <ctime>

namespace linescope::shared {

bool futex_wait(const std::uint32_t& word, std::uint32_t expected, Nanoseconds deadline,
                std::uint32_t bits) noexcept {
  timespec until{};
  until.tv_sec = static_cast<time_t>(deadline / kSecond);
  until.tv_nsec = static_cast<long>(deadline % kSecond);
  return syscall(SYS_futex, &word, FUTEX_WAIT_BITSET, expected, &until, nullptr, bits) == 0;
}

void futex_wake(std::uint32_t& word, std::uint32_t bits) noexcept {
  syscall(SYS_futex, &word, FUTEX_WAKE_BITSET, INT_MAX, nullptr, nullptr, bits);
}

}  // namespace linescope::shared
