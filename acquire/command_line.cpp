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

constexpr const char* kAbout =
    R"(linescope-acquire: from a camera and a position tracker to surface points in shared memory.

Finds the laser line in every picture, places it where the tracker says the endoscope was in the middle
of the exposure, and publishes points, poses, pictures and states in one segment that any number of
viewers may read (docs/segment.md). Without options it runs the simulated instrument. It runs in the
foreground until it is told to stop; viewers may come and go. Answers go to standard output, everything
said along the way to standard error.
)";

constexpr const char* kFooter = R"(Values:
  Every key of the configuration file can be set with --set section.key=value; --print-config shows all of them with
  unit, range and default (docs/configuration.md). What comes later wins: defaults, file, command line.

Signals:
  SIGTERM, SIGINT, SIGHUP: end in good order; a recording is completed and the segment is removed.

Exit codes:
  0 ok   1 failed   2 command line   3 configuration   4 calibration   5 camera   6 tracker
  7 already running under this segment name   8 segment cannot be created, or was taken over

Examples:
  linescope-acquire --scan                                    the simulated instrument
  linescope-acquire --list                                    what is plugged in, and what cannot be used
  linescope-acquire -c knee.toml --check                      is everything there? starts nothing
  linescope-acquire -c knee.toml --record scan-07             scan and record
  linescope-acquire --replay scan-07 --scan --fast            the same points again
  linescope-acquire --camera frames --tracker poses.csv --calibration c.yaml --scan --exit-at-end
  linescope-acquire --camera none --tracker liberty --calibration c.yaml      poses only

Files:
  /dev/shm/NAME, /dev/shm/NAME*   the segment and its control mailbox (--segment NAME)
  tools/udev/60-linescope-liberty.rules, tools/systemd/linescope-acquire.service

See also: docs/liberty.md, docs/recording.md, docs/troubleshooting.md, linescope-viewer, linescope-inspect.
Research software. Not for clinical use.)";

class OptionTable {
 public:
  OptionTable(CLI::App& app, Typed& typed) : app_(app), typed_(typed) {}

  /// The options that follow belong under this heading.
  void heading(std::string text) { heading_ = std::move(text); }

  void value(const std::string& names, const std::string& key, const std::string& type,
             const std::string& help) {
    app_.add_option_function<std::string>(
            names,
            [&typed = typed_, key](const std::string& text) {
              typed.assignments.push_back(key + "=" + text);
            },
            help)
        ->type_name(type)
        ->group(heading_);
  }
  void flag(const std::string& names, const std::string& assignment, const std::string& help) {
    app_.add_flag_callback(
            names, [&typed = typed_, assignment] { typed.assignments.push_back(assignment); }, help)
        ->group(heading_);
  }
  void task(const std::string& names, bool& field, const std::string& help) {
    app_.add_flag(names, field, help)->group(heading_);
  }
  void assignments(const std::string& names, const std::string& help) {
    app_.add_option_function<std::vector<std::string>>(
            names,
            [&typed = typed_](const std::vector<std::string>& values) {
              typed.assignments.insert(typed.assignments.end(), values.begin(), values.end());
            },
            help)
        ->type_name("KEY=VALUE")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->group(heading_);
  }

 private:
  CLI::App& app_;
  Typed& typed_;
  std::string heading_;
};

void declare_inputs(OptionTable& options) {
  options.heading("Where pictures and poses come from");
  options.value(
      "--camera", "camera.source", "SOURCE",
      "twin, a folder of pictures, a video file, a camera (path, index or part of its name), or none");
  options.value("--tracker", "tracker.source", "SOURCE", "twin, liberty, a CSV file of poses, or none");
  options.value("--calibration", "reconstruct.calibration", "FILE",
                "Calibration file, or one of the presets thesis-camera-i and thesis-camera-ii");
  options.value("--replay", "run.replay", "DIR", "Play a recording instead of camera and tracker");
  options.value("--seed", "twin.seed", "N", "Seed of the simulated instrument: same seed, same bytes");
}

void declare_run_options(OptionTable& options) {
  options.heading("What is done");
  options.flag("--scan", "run.scan_at_start=true",
               "Take points at once instead of waiting for the Scan button");
  options.flag("--fast", "run.pace=fast", "Play recorded and simulated sources as fast as possible");
  options.flag("--exit-at-end", "run.exit_at_end=true", "End when a recorded source is through");
  options.value("--segment", "run.segment", "NAME", "Name of the shared-memory segment");
  options.value("--record", "run.record", "DIR", "Record everything to this new folder");
  options.value("--truth", "twin.truth", "FILE",
                "Write what the simulated instrument really did there (JSON)");
  options.value("--log-level", "log.level", "LEVEL", "debug, info, warning or error");
  options.value("--log-file", "log.file", "FILE", "Append the log to this file as well");
}

void declare_options(CLI::App& app, Typed& typed) {
  OptionTable options(app, typed);
  declare_inputs(options);
  declare_run_options(options);
  options.heading("Configuration");
  app.add_option("-c,--config", typed.config, "Configuration file (TOML)")
      ->type_name("FILE")
      ->group("Configuration");
  options.assignments("--set", "Any key of the configuration file; may be repeated");
  options.task("--check", typed.check,
               "Check configuration, calibration and devices, say what was found; starts nothing");
  options.task("--print-config", typed.print_config, "Print the effective configuration and end");
  options.task("--print-keys", typed.print_keys, "Print every key as a table (Markdown) and end");
  options.heading("Information");
  options.task("--list", typed.list, "List cameras and trackers, and why one cannot be used");
  app.set_version_flag("--version", std::string("linescope-acquire ") + kVersion)->group("Information");
  app.set_help_flag("-h,--help", "This text")->group("Information");
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
  CLI::App app(kAbout, "linescope-acquire");
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
  if (auto applied = apply_keys(out.options.tracker_keys, out.options.tracker); !applied)
    return Refused(Refusal{ExitCode::configuration, applied.error().message});
  if (typed.list) {  // what is plugged in does not depend on what is configured
    out.task = CommandLine::Task::list;
    return out;
  }
  if (auto ok = validate(out.options); !ok)
    return Refused(Refusal{ExitCode::configuration, ok.error().message});
  out.configuration = schema.to_toml();
  if (typed.print_keys) {
    out.task = CommandLine::Task::stop_here;
    out.printed = schema.to_markdown();
    return out;
  }
  if (typed.check) out.task = CommandLine::Task::check;
  if (typed.print_config) out.task = CommandLine::Task::print_config;
  return out;
}

}  // namespace linescope
