// Who a process is, beyond its pid: pids are used again, and mean something else in another pid namespace.
#pragma once

#include <cstdint>
#include <string>

namespace linescope {

struct ProcessIdentity {
  std::uint32_t pid = 0;
  std::uint64_t start_ticks = 0;    ///< since boot; 0: unknown
  std::uint64_t pid_namespace = 0;  ///< inode; 0: unknown
};

ProcessIdentity this_process();

/// True only when it is certain: same pid namespace, and no such process, or one that started at another
/// time, or a zombie. False means "cannot tell", not "alive".
bool provably_ended(const ProcessIdentity& process);

/// "root", or "uid 1234" when the user has no name.
std::string user_name(std::uint32_t uid);

}  // namespace linescope
