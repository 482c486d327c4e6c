// A program under test: spawned, watched, killed. What it prints goes to files that can be read at any time.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace linescope::testing {

/// A folder that is gone with its owner.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

struct ProcessEnd {
  bool signalled = false;
  int code = 0;  ///< exit code, or the signal's number
};

/// Killed (SIGKILL) and reaped by the destructor at the latest.
class ChildProcess {
 public:
  /// `arguments[0]` is the program; `environment` holds NAME=VALUE on top of the present environment.
  explicit ChildProcess(std::vector<std::string> arguments, std::vector<std::string> environment = {});
  ~ChildProcess();
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&&) = delete;

  pid_t pid() const { return pid_; }
  void send(int signal) const;
  bool running();
  /// The end, or nothing when it has not come in time.
  std::optional<ProcessEnd> wait(std::chrono::milliseconds timeout);
  std::string standard_output() const;
  std::string standard_error() const;

 private:
  pid_t pid_ = -1;
  std::optional<ProcessEnd> end_;
  std::filesystem::path out_, err_;
};

/// Polls `condition` until it holds (true) or the time is over (false).
bool eventually(const std::function<bool()>& condition,
                std::chrono::milliseconds timeout = std::chrono::seconds(20));

/// A segment name no other test uses.
std::string unique_segment();

/// Names in /dev/shm that begin with `segment`.
std::vector<std::string> leftovers(const std::string& segment);

/// Removes them: what a killed daemon leaves.
void remove_leftovers(const std::string& segment);

}  // namespace linescope::testing
