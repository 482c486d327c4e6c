#include "acquire/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <vector>

#include "common/version.hpp"

namespace linescope {
namespace {

using Refused = tl::unexpected<Refusal>;

/// What was typed. Everything that has a key is kept as an assignment, so that one schema checks both worlds.
struct Typed {
  std::string config;
  std::vector<std::string> assignments;
  bool check = false, print_config = false, print_keys = false, list = false;
};

constexpr const char* kFooter =
    "Every key of the configuration file can also be set with --set section.key=value "
    "(docs/configuration.md).\n"
    "Exit codes: 0 ok, 1 failed, 2 command line, 3 configuration, 4 calibration, 5 camera, 6 tracker, 7 "
    "already running, 8 segment.\n"
    "Research software. Not for clinical use.";

void assignment_option(CLI::App& app, Typed& typed, const std::string& names, const std::string& key,
                       const std::string& help, const std::string& type) {
  app.add_option_function<std::string>(
         names, [&typed, key](const std::string& value) { typed.assignments.push_back(key + "=" + value); },
         help)
      ->type_name(type);
}

void assignment_flag(CLI::App& app, Typed& typed, const std::string& names, const std::string& assignment,
                     const std::string& help) {
  app.add_flag_callback(
      names, [&typed, assignment] { typed.assignments.push_back(assignment); }, help);
}

void declare_options(CLI::App& app, Typed& typed) {
  app.add_option("-c,--config", typed.config, "Configuration file (TOML)")->type_name("FILE");
  assignment_option(app, typed, "--segment", "run.segment", "Name of the shared-memory segment", "NAME");
  assignment_option(app, typed, "--camera", "camera.source",
                    "twin, a folder of pictures, a video file, or a camera", "SOURCE");
  assignment_option(app, typed, "--tracker", "tracker.source", "twin, liberty, none, or a CSV file of poses",
                    "SOURCE");
  assignment_option(app, typed, "--calibration", "reconstruct.calibration",
                    "Calibration file, thesis-camera-i or thesis-camera-ii", "FILE");
  assignment_option(app, typed, "--seed", "twin.seed", "Seed of the twin: same seed, same bytes", "N");
  assignment_option(app, typed, "--truth", "twin.truth", "Write the twin's truth there (JSON)", "FILE");
  assignment_option(app, typed, "--record", "run.record", "Record pictures and samples to this folder",
                    "DIR");
  assignment_option(app, typed, "--replay", "run.replay", "Play a recording instead of camera and tracker",
                    "DIR");
  assignment_flag(app, typed, "--scan", "run.scan_at_start=true", "Scan at once");
  assignment_flag(app, typed, "--fast", "run.pace=fast",
                  "Play recorded and simulated sources as fast as possible");
  assignment_flag(app, typed, "--exit-at-end", "run.exit_at_end=true",
                  "End when a recorded source is through");
  app.add_option_function<std::vector<std::string>>(
         "--set",
         [&typed](const std::vector<std::string>& values) {
           typed.assignments.insert(typed.assignments.end(), values.begin(), values.end());
         },
         "Any key of the configuration file, may be repeated")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_flag("--check", typed.check, "Check configuration, calibration and sources; start nothing");
  app.add_flag("--print-config", typed.print_config, "Print the effective configuration and end");
  app.add_flag("--print-keys", typed.print_keys,
               "Print every key as the tables of docs/configuration.md and end");
  app.add_flag("--list", typed.list, "List the cameras of this machine and end");
  app.set_version_flag("--version", std::string("linescope-acquire ") + kVersion);
  app.footer(kFooter);
}

std::string all_of(const std::vector<ConfigFault>& faults) {
  std::string text;
  for (const ConfigFault& fault : faults) text += (text.empty() ? "" : "\n") + fault.message;
  return text;
}

tl::expected<void, Refusal> fill(ConfigSchema& schema, const Typed& typed) {
  if (!typed.config.empty()) {
    const auto faults = schema.read_file(typed.config);
    if (!faults.empty()) return Refused(Refusal{ExitCode::configuration, all_of(faults)});
  }
  for (const std::string& assignment : typed.assignments) {
    if (auto ok = schema.set(assignment); !ok) return Refused(Refusal{ExitCode::usage, ok.error().message});
  }
  return {};
}

}  // namespace

tl::expected<CommandLine, Refusal> read_command_line(int argc, const char* const* argv) {
  CLI::App app("linescope-acquire: camera and tracker to points and poses in shared memory.",
               "linescope-acquire");
  Typed typed;
  declare_options(app, typed);
  CommandLine out;
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) {
      out.task = CommandLine::Task::stop_here;
      out.printed =
          dynamic_cast<const CLI::CallForVersion*>(&e) != nullptr ? std::string(e.what()) + "\n" : app.help();
      return out;
    }
    return Refused(Refusal{ExitCode::usage, fmt::format("{} (linescope-acquire --help)", e.what())});
  }
  ConfigSchema schema;
  declare(schema, out.options);
  if (auto filled = fill(schema, typed); !filled) return Refused(filled.error());
  if (auto ok = validate(out.options); !ok)
    return Refused(Refusal{ExitCode::configuration, ok.error().message});
  out.configuration = schema.to_toml();
  if (typed.print_keys) {
    out.task = CommandLine::Task::stop_here;
    out.printed = schema.to_markdown();
    return out;
  }
  if (typed.check) out.task = CommandLine::Task::check;
  if (typed.list) out.task = CommandLine::Task::list;
  if (typed.print_config) out.task = CommandLine::Task::print_config;
  return out;
}

}  // namespace linescope
