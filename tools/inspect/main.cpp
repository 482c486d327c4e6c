// linescope-inspect: what a segment holds, once or again and again, for people or machines.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <string>
#include <thread>

#include "tools/inspect/snapshot.hpp"

namespace linescope {
namespace {

/// For scripts.
enum ExitCode { kLive = 0, kUsage = 2, kNoSegment = 3, kNotLive = 4, kUnreadable = 5 };

struct InspectOptions {
  AttachOptions attach;
  bool json = false;
  bool all = false;
  bool watch = false;
  double interval = 1;  ///< s
  int times = 0;        ///< 0: for ever
};

ExitCode code_for(ErrorCode code) {
  return code == ErrorCode::not_found || code == ErrorCode::busy ? kNoSegment : kUnreadable;
}

void print(const SegmentSnapshot& snapshot, const InspectOptions& options) {
  const bool terminal_page = options.watch && !options.json;
  const std::string text = options.json ? as_json(snapshot) + "\n" : as_text(snapshot, options.all);
  if (terminal_page) std::fputs("\x1b[H\x1b[2J", stdout);
  std::fputs(text.c_str(), stdout);
  std::fflush(stdout);
}

ExitCode inspect_once(const InspectOptions& options) {
  auto reader = SegmentReader::attach(options.attach);
  if (!reader) {
    std::fprintf(stderr, "linescope-inspect: %s\n", reader.error().message.c_str());
    return code_for(reader.error().code);
  }
  const SnapshotResult result = take_snapshot(*reader, monotonic_now());
  print(result.snapshot, options);
  if (result.corrupt) {
    std::fprintf(stderr, "linescope-inspect: segment %s is damaged: restart the daemon\n",
                 options.attach.name.c_str());
    return kUnreadable;
  }
  return result.snapshot.life.life == Life::live ? kLive : kNotLive;
}

/// Attaches anew each time: a daemon that was restarted is simply shown.
ExitCode inspect(const InspectOptions& options) {
  ExitCode code = inspect_once(options);
  for (int i = 1; options.watch && (options.times == 0 || i < options.times); ++i) {
    std::this_thread::sleep_for(std::chrono::duration<double>(options.interval));
    code = inspect_once(options);
  }
  return code;
}

void declare(CLI::App& app, InspectOptions& options) {
  app.add_option("segment", options.attach.name, "name of the segment")->capture_default_str();
  app.add_flag("--json", options.json, "one line of JSON");
  app.add_flag("--all", options.all, "also counters and times that are zero");
  app.add_flag("--watch", options.watch, "again and again");
  app.add_option("--interval", options.interval, "seconds between two looks of --watch")
      ->check(CLI::Range(0.01, 3600.0))
      ->capture_default_str();
  app.add_option("--times", options.times, "end --watch after so many looks (0: never)")
      ->check(CLI::Range(0, 1'000'000'000));
  app.add_flag("--other-owner", options.attach.other_owner, "also a segment that belongs to another user");
  app.footer(
      "Exit code: 0 a living daemon, 2 wrong usage, 3 no segment, 4 the daemon is dead or silent, 5 not "
      "readable or damaged.");
}

}  // namespace
}  // namespace linescope

int main(int argc, char** argv) {
  linescope::InspectOptions options;
  options.attach.prefault = false;
  options.attach.wake_ups = false;
  CLI::App app("Shows what a linescope segment holds");
  linescope::declare(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : linescope::kUsage;
  }
  return linescope::inspect(options);
}
