#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <atomic>
#include <csignal>
#include <cstdio>

#include "acquire/camera/camera_list.hpp"
#include "acquire/daemon.hpp"

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
  std::fprintf(stderr, "linescope-acquire: %s\n", refusal.message.c_str());
  return linescope::exit_status(refusal.exit);
}

int list_devices() {
  const auto cameras = linescope::list_cameras();
  if (cameras.empty()) std::puts("no camera: no /dev/video* on this machine");
  for (const auto& camera : cameras)
    std::printf("camera %s  %s  %s\n", camera.path.c_str(), camera.name.c_str(),
                camera.usable() ? "usable" : camera.obstacle.c_str());
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
  const auto outcome = linescope::run_daemon(command, stop_requested);
  return outcome ? 0 : refuse(outcome.error());
}

}  // namespace

int main(int argc, char** argv) {
  // Standard output belongs to answers; everything that is said along the way goes to standard error.
  spdlog::set_default_logger(spdlog::stderr_color_mt("linescope-acquire"));
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
