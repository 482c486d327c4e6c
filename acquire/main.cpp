#include <atomic>
#include <csignal>
#include <cstdio>

#include "acquire/daemon.hpp"
#include "acquire/device_list.hpp"
#include "acquire/logging.hpp"

namespace {

std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set from a signal handler");

void on_signal(int) {
  stop_requested = true;
}

void catch_signals() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGHUP, &action, nullptr);
}

int refuse(const linescope::Refusal& refusal) {
  linescope::log_refusal(refusal);
  return linescope::exit_status(refusal.exit);
}

int list_devices() {
  std::fputs(linescope::list_text(linescope::list_cameras(), linescope::find_trackers()).c_str(), stdout);
  return 0;
}

int check(const linescope::AcquireOptions& options) {
  const auto found = linescope::check_setup(options);
  if (!found) return refuse(found.error());
  std::puts(found->c_str());
  return 0;
}

int run(const linescope::CommandLine& command) {
  catch_signals();
  if (auto log = linescope::open_log(command.options.log); !log)
    return refuse({linescope::ExitCode::configuration, log.error().message});
  const auto outcome = linescope::run_daemon(command, stop_requested);
  return outcome ? 0 : refuse(outcome.error());
}

}  // namespace

int main(int argc, char** argv) {
  // Standard output belongs to answers; everything that is said along the way goes to standard error.
  if (auto log = linescope::open_log({}); !log)
    return refuse({linescope::ExitCode::failed, log.error().message});
  const auto command = linescope::read_command_line(argc, argv);
  if (!command) return refuse(command.error());
  using Task = linescope::CommandLine::Task;
  switch (command->task) {
    case Task::stop_here:
      std::fputs(command->printed.c_str(), stdout);
      return 0;
    case Task::print_config:
      std::fputs(command->configuration.c_str(), stdout);
      return 0;
    case Task::list:
      return list_devices();
    case Task::check:
      return check(command->options);
    case Task::run:
      break;
  }
  return run(*command);
}
