#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>

#include "common/exit_code.hpp"
#include "common/version.hpp"
#include "tools/export/export_recording.hpp"

namespace {

using linescope::ExitCode;
using Export = linescope::Result<linescope::ExportReport> (*)(const std::filesystem::path&,
                                                              const std::filesystem::path&);

/// One line on standard output for people, one sentence on standard error when it fails.
ExitCode run(Export task, const std::string& recording, const std::string& target) {
  const auto report = task(recording, target);
  if (!report) {
    fmt::print(stderr, "linescope-export: {}\n", report.error().message);
    return ExitCode::failed;
  }
  fmt::print("{}: {} written", target, report->written);
  if (report->without_pose > 0) fmt::print(", {} without a good pose of every tool", report->without_pose);
  if (report->damaged > 0) fmt::print(", {} damaged records passed over", report->damaged);
  if (report->other_size > 0) fmt::print(", {} pictures of another size left out", report->other_size);
  if (!report->remark.empty()) fmt::print(" ({})", report->remark);
  fmt::print("\n");
  return ExitCode::ok;
}

struct Typed {
  std::string recording, sequence, tracker, poses, pictures, events;
};

void declare(CLI::App& app, Typed& typed) {
  app.set_version_flag("--version", std::string("linescope-export ") + linescope::kVersion);
  app.add_option("RECORDING", typed.recording, "Folder written by linescope-acquire --record")->required();
  app.add_option(
         "--sequence", typed.sequence,
         "PLUS/3D Slicer sequence (.igs.mha): pictures with the transforms at their middle of exposure")
      ->type_name("FILE");
  app.add_option("--tracker", typed.tracker,
                 "PLUS/3D Slicer sequence (.igs.mha): every tracker cycle, no pictures")
      ->type_name("FILE");
  app.add_option("--poses", typed.poses, "Tracker samples as CSV; linescope-acquire --tracker reads it")
      ->type_name("FILE");
  app.add_option("--pictures", typed.pictures, "Pictures as PNG files, with their times in pictures.csv")
      ->type_name("FOLDER");
  app.add_option("--events", typed.events, "Events as text lines")->type_name("FILE");
  app.footer(
      "Units: mm, seconds on CLOCK_MONOTONIC. World is the tracker's transmitter (docs/recording.md).\n"
      "Exit codes: 0 ok, 1 failed, 2 command line.\nResearch software. Not for clinical use.");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Converts a recording of linescope into files of other programs.");
  Typed typed;
  declare(app, typed);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : linescope::exit_status(ExitCode::usage);
  }
  if ((typed.sequence + typed.tracker + typed.poses + typed.pictures + typed.events).empty()) {
    fmt::print(stderr,
               "linescope-export: nothing is asked for; give --sequence, --tracker, --poses, --pictures or "
               "--events\n");
    return exit_status(ExitCode::usage);
  }
  const std::pair<std::string, Export> tasks[] = {{typed.sequence, linescope::export_pictures_sequence},
                                                  {typed.tracker, linescope::export_tracker_sequence},
                                                  {typed.poses, linescope::export_poses_csv},
                                                  {typed.pictures, linescope::export_pictures},
                                                  {typed.events, linescope::export_events}};
  for (const auto& [target, task] : tasks) {
    if (target.empty()) continue;
    if (const ExitCode code = run(task, typed.recording, target); code != ExitCode::ok)
      return exit_status(code);
  }
  return 0;
}
