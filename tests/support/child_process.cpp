#include "tests/support/child_process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <stdexcept>
#include <thread>

#include "tests/support/finished_run.hpp"

namespace linescope::testing {
namespace {

std::filesystem::path scratch_file() {
  std::string pattern = (std::filesystem::temp_directory_path() / "linescope-test-XXXXXX").string();
  const int fd = mkstemp(pattern.data());
  if (fd < 0) throw std::runtime_error("no scratch file");
  close(fd);
  return pattern;
}

void redirect(const std::filesystem::path& file, int descriptor) {
  const int fd = open(file.c_str(), O_WRONLY | O_TRUNC);
  if (fd >= 0) dup2(fd, descriptor);
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "linescope-test-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

ChildProcess::ChildProcess(std::vector<std::string> arguments, std::vector<std::string> environment)
    : out_(scratch_file()), err_(scratch_file()) {
  pid_ = fork();
  if (pid_ < 0) throw std::runtime_error("fork failed");
  if (pid_ > 0) return;
  redirect(out_, STDOUT_FILENO);
  redirect(err_, STDERR_FILENO);
  for (std::string& variable : environment) putenv(variable.data());
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  execvp(argv[0], argv.data());
  _exit(127);
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : pid_(other.pid_), end_(other.end_), out_(std::move(other.out_)), err_(std::move(other.err_)) {
  other.pid_ = -1;
}

ChildProcess::~ChildProcess() {
  if (pid_ < 0) return;
  if (running()) {
    send(SIGKILL);
    wait(std::chrono::seconds(10));
  }
  std::error_code ignored;
  std::filesystem::remove(out_, ignored);
  std::filesystem::remove(err_, ignored);
}

void ChildProcess::send(int signal) const {
  kill(pid_, signal);
}

bool ChildProcess::running() {
  return !wait(std::chrono::milliseconds(0)).has_value();
}

std::optional<ProcessEnd> ChildProcess::wait(std::chrono::milliseconds timeout) {
  const auto give_up = std::chrono::steady_clock::now() + timeout;
  while (!end_) {
    int status = 0;
    if (waitpid(pid_, &status, WNOHANG) == pid_) {
      end_ =
          WIFSIGNALED(status) ? ProcessEnd{true, WTERMSIG(status)} : ProcessEnd{false, WEXITSTATUS(status)};
      break;
    }
    if (std::chrono::steady_clock::now() >= give_up) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return end_;
}

std::string ChildProcess::standard_output() const {
  return file_contents(out_);
}
std::string ChildProcess::standard_error() const {
  return file_contents(err_);
}

bool eventually(const std::function<bool()>& condition, std::chrono::milliseconds timeout) {
  const auto give_up = std::chrono::steady_clock::now() + timeout;
  while (!condition()) {
    if (std::chrono::steady_clock::now() >= give_up) return condition();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return true;
}

std::string unique_segment() {
  static std::atomic<int> number{0};
  return "linescope-test-" + std::to_string(getpid()) + "-" + std::to_string(number++);
}

std::vector<std::string> leftovers(const std::string& segment) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator("/dev/shm")) {
    if (entry.path().filename().string().rfind(segment, 0) == 0) names.push_back(entry.path().filename());
  }
  return names;
}

void remove_leftovers(const std::string& segment) {
  for (const std::string& left : leftovers(segment)) unlink(("/dev/shm/" + left).c_str());
}

}  // namespace linescope::testing
