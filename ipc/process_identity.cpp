#include "ipc/process_identity.hpp"

#include <fmt/format.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <optional>
#include <sstream>
#include <vector>

namespace linescope {
namespace {

struct ProcStat {
  char state = '?';
  std::uint64_t start_ticks = 0;
};

std::optional<ProcStat> proc_stat(std::uint32_t pid) {
  std::ifstream file(fmt::format("/proc/{}/stat", pid));
  std::string line;
  if (!std::getline(file, line)) return std::nullopt;
  // The second field is the program's name in brackets and may itself hold brackets and blanks.
  const std::size_t name_end = line.rfind(')');
  if (name_end == std::string::npos) return std::nullopt;
  std::istringstream rest(line.substr(name_end + 1));
  ProcStat stat;
  std::string skipped;
  rest >> stat.state;
  for (int field = 4; field < 22; ++field) rest >> skipped;
  rest >> stat.start_ticks;
  return stat;
}

bool proc_is_there() {
  return ::access("/proc/self/stat", R_OK) == 0;
}

std::uint64_t own_pid_namespace() {
  struct stat s {};
  return ::stat("/proc/self/ns/pid", &s) == 0 ? s.st_ino : 0;
}

}  // namespace

ProcessIdentity this_process() {
  const auto pid = static_cast<std::uint32_t>(::getpid());
  const auto stat = proc_stat(pid);
  return {pid, stat ? stat->start_ticks : 0, own_pid_namespace()};
}

bool provably_ended(const ProcessIdentity& process) {
  if (process.pid == 0 || process.pid_namespace == 0 || process.start_ticks == 0) return false;
  if (process.pid_namespace != own_pid_namespace() || !proc_is_there()) return false;
  const auto stat = proc_stat(process.pid);
  if (!stat) return ::access(fmt::format("/proc/{}", process.pid).c_str(), F_OK) != 0;
  return stat->state == 'Z' || stat->state == 'X' || stat->start_ticks != process.start_ticks;
}

std::string user_name(std::uint32_t uid) {
  std::vector<char> buffer(4096);
  passwd entry{};
  passwd* found = nullptr;
  if (::getpwuid_r(uid, &entry, buffer.data(), buffer.size(), &found) == 0 && found != nullptr)
    return entry.pw_name;
  return fmt::format("uid {}", uid);
}

}  // namespace linescope
