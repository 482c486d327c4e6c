// linescope-evaluate: the thesis's tables with ours beside them, on the digital twin or on a recorded
// session.
#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <opencv2/core/utility.hpp>

#include "common/exit_code.hpp"
#include "common/version.hpp"
#include "tools/evaluate/recorded_session.hpp"
#include "tools/evaluate/sections.hpp"

namespace linescope::evaluate {
namespace {

struct Command {
  bool quick = false;
  int seeds = 0;  ///< 0: the form's own
  int jobs = 0;
  std::vector<std::string> only;
  bool json = false;
  std::string html;
  std::string replay;
  std::string shape;
};

std::vector<std::string> section_names() {
  std::vector<std::string> names;
  for (const SectionMaker& maker : section_makers()) names.emplace_back(maker.id);
  return names;
}

void declare(CLI::App& app, Command& c) {
  app.set_version_flag("--version", std::string("linescope-evaluate ") + kVersion);
  app.add_flag("--quick", c.quick, "Three seeds and short scans: under a minute, wide intervals");
  app.add_option("--seeds", c.seeds, "Experiments per figure (20; quick: 3)")->check(CLI::Range(1, 10'000));
  app.add_option("--jobs", c.jobs, "Experiments at the same time (2); the figures do not depend on it")
      ->check(CLI::Range(1, 256));
  app.add_option("--only", c.only,
                 "Some sections only: " + fmt::format("{}", fmt::join(section_names(), ", ")))
      ->delimiter(',')
      ->check(CLI::IsMember(section_names()));
  app.add_flag("--json", c.json, "Write JSON instead of text to standard output");
  app.add_option("--html", c.html, "Also write an HTML report with drawings to this file")->type_name("FILE");
  auto* replay = app.add_option("--replay", c.replay, "A recording instead of the twin")
                     ->type_name("DIR")
                     ->excludes("--quick");
  app.add_option("--shape", c.shape, "What was scanned there: plane or cylinder-DIAMETER")->needs(replay);
  app.footer(
      "Exit codes: 0 done, 1 failed or not written, 2 wrong usage.\n"
      "Simulated unless --replay is given. Research software. Not for clinical use.");
}

Form form_of(const Command& c) {
  Form form = c.quick ? quick_form() : Form{};
  if (c.seeds > 0) form.seeds = c.seeds;
  if (c.jobs > 0) form.jobs = c.jobs;
  return form;
}

bool wanted(const Command& c, std::string_view id) {
  return c.only.empty() || std::find(c.only.begin(), c.only.end(), id) != c.only.end();
}

Result<Report> evaluate_twin(const Command& c) {
  const Form form = form_of(c);
  Report report{"linescope: evaluation on the digital twin", {kSimulated}, {}};
  report.setting.push_back(fmt::format("Preset \"thesis\", {} seed{}, {:g} s per scan.", form.seeds,
                                       form.seeds == 1 ? "" : "s", form.scan_seconds));
  for (const SectionMaker& maker : section_makers()) {
    if (!wanted(c, maker.id)) continue;
    fmt::print(stderr, "linescope-evaluate: {}\n", maker.id);
    auto sections = maker.make(form);
    if (!sections)
      return fail(sections.error().code, fmt::format("section {}: {}", maker.id, sections.error().message));
    for (Section& section : *sections) report.sections.push_back(std::move(section));
  }
  return report;
}

Result<Report> evaluate(const Command& c) {
  if (c.replay.empty()) return evaluate_twin(c);
  auto shape = known_shape(c.shape);
  if (!shape) return tl::unexpected(shape.error());
  return evaluate_recording(c.replay, *shape);
}

ExitCode refuse(ExitCode code, const std::string& message) {
  fmt::print(stderr, "linescope-evaluate: {}\n", message);
  return code;
}

ExitCode run(const Command& c) {
  // What the daemon says of a device's coming and going is of no use here: thousands of sessions begin and
  // end.
  spdlog::set_level(spdlog::level::err);
  // The experiments are the parallel part; threads inside of one would only be in each other's way.
  cv::setNumThreads(1);
  auto report = evaluate(c);
  if (!report)
    return refuse(report.error().code == ErrorCode::usage ? ExitCode::usage : ExitCode::failed,
                  report.error().message);
  fmt::print("{}", c.json ? as_json(*report) : as_text(*report));
  if (c.html.empty()) return ExitCode::ok;
  std::ofstream out(c.html);
  out << as_html(*report);
  out.close();
  if (!out) return refuse(ExitCode::failed, fmt::format("{}: the report cannot be written there", c.html));
  return ExitCode::ok;
}

}  // namespace
}  // namespace linescope::evaluate

int main(int argc, char** argv) {
  CLI::App app("The tables of the thesis with ours beside them.", "linescope-evaluate");
  linescope::evaluate::Command command;
  linescope::evaluate::declare(app, command);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : linescope::exit_status(linescope::ExitCode::usage);
  }
  return linescope::exit_status(linescope::evaluate::run(command));
}
