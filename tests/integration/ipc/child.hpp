// A child process that may be killed at any instant.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <functional>
#include <string>
#include <vector>

namespace linescope::testing {

class Child {
 public:
  /// Runs a program with its standard output and errors in the file `output` (nowhere when empty).
  static Child program(const std::vector<std::string>& arguments, const std::string& output = "");
  /// Runs `body` in a fork; the child ends when it returns.
  static Child fork(const std::function<void()>& body);

  Child(Child&& other) noexcept : pid_(other.pid_) { other.pid_ = -1; }
  Child& operator=(Child&& other) noexcept;
  ~Child() { kill(); }

  void signal(int number) const { ::kill(pid_, number); }
  /// kill -9, and waits for its end.
  void kill();
  /// Waits for its end; the status of waitpid.
  int wait();
  pid_t pid() const { return pid_; }

 private:
  explicit Child(pid_t pid) : pid_(pid) {}
  pid_t pid_;
};

}  // namespace linescope::testing
