// linescope-calibrate: camera, laser, hand-eye, harvester, time and the check, step by step, with a verdict
// at each.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "common/version.hpp"
#include "tools/calibrate/run.hpp"

namespace linescope::calibrate {
namespace {

std::string steps_text() {
  std::string text = "Steps, in this order:\n";
  for (const auto& step : all_steps()) text += fmt::format("  {:<10} {}\n", step->name(), step->about());
  text += "  show       explains a calibration file\n";
  text +=
      "  import     takes the camera from OpenCV YAML, ROS camera_info YAML or a preset (thesis-camera-i, "
      "thesis-camera-ii)\n";
  return text;
}

void declare(CLI::App& app, Command& c) {
  app.set_version_flag("--version", std::string("linescope-calibrate ") + kVersion);
  app.add_option("step", c.step, "What is done: see below")->type_name("STEP");
  app.add_option("file", c.file, "show: the calibration; import: what is read")->type_name("FILE");
  app.add_option("--calibration", c.calibration, "Calibration file that is read and written")
      ->type_name("FILE");
  auto* from = app.add_option("--from", c.from,
                              "Folder of pictures, recording, video or CSV of poses; without it: live")
                   ->type_name("PATH");
  app.add_option("--segment", c.segment, "Live: name of the daemon's segment")
      ->capture_default_str()
      ->excludes(from);
  app.add_option("--seconds", c.seconds, "Live: at most so long")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  app.add_option("-c,--config", c.config, "Configuration file (TOML) with board and limits")
      ->type_name("FILE");
  app.add_option("--set", c.assignments, "Any key of the configuration; may be repeated")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option("--plots", c.plots, "Folder for drawings (PNG)")->type_name("DIR");
  app.add_flag("--dry-run", c.dry_run, "Show everything, store nothing");
  app.add_flag("--print-config", c.print_config, "Print the effective configuration and end");
  app.add_flag("--print-keys", c.print_keys, "Print every key as a table (Markdown) and end");
  app.footer(
      steps_text() +
      "\nExit codes: 0 good, 1 failed, 2 wrong usage, 3 configuration, 4 calibration file, 5 no pictures or "
      "poses, 9 refused: the data are not good enough.\nResearch software. Not for clinical use.");
}

/// What is missing, in one sentence; empty: nothing.
std::string missing(const Command& c) {
  if (c.print_config || c.print_keys) return {};
  if (c.step.empty()) return "say which step (linescope-calibrate --help)";
  const bool takes_file = c.step == "show" || c.step == "import";
  if (takes_file && c.file.empty()) return c.step + " needs a FILE";
  if (!takes_file && !c.file.empty())
    return "only show and import take a FILE: pictures are given with --from";
  if (c.step != "show" && c.calibration.empty()) return "--calibration FILE says where the result goes";
  return {};
}

}  // namespace
}  // namespace linescope::calibrate

int main(int argc, char** argv) {
  using namespace linescope::calibrate;
  CLI::App app("Calibration, step by step, with a verdict at each.", "linescope-calibrate");
  Command command;
  declare(app, command);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kOk : kUsage;
  }
  if (const std::string fault = missing(command); !fault.empty()) {
    fmt::print(stderr, "linescope-calibrate: {}\n", fault);
    return kUsage;
  }
  return run(command);
}
