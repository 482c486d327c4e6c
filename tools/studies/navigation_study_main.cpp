// navigation_study: prints the navigation table (docs/navigation.md). Takes minutes: it renders every
// picture.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "tools/studies/navigation_study.hpp"

namespace linescope::study {
namespace {

struct StudyCommand {
  NavigationStudyOptions options;
  std::vector<std::string> only;
  bool limits = false;
};

bool wanted(const StudyCommand& command, const std::string& name) {
  if (command.only.empty()) return true;
  for (const std::string& part : command.only)
    if (name.find(part) != std::string::npos) return true;
  return false;
}

int complain(const Error& error) {
  fmt::print(stderr, "navigation_study: {}\n", error.message);
  return 1;
}

int print_table(const StudyCommand& command) {
  fmt::print("{}", navigation_table_head());
  for (const StudyCondition& condition : navigation_conditions()) {
    if (!wanted(command, condition.name)) continue;
    const auto row = run_navigation_study(condition, command.options);
    if (!row) return complain(row.error());
    fmt::print("{}", navigation_table_line(*row));
    std::fflush(stdout);
  }
  return 0;
}

int print_limits(const StudyCommand& command) {
  fmt::print("| condition | without | ours: mean | 95 % | answered |\n| --- | --- | --- | --- | --- |\n");
  for (const StudyCondition& condition : navigation_conditions()) {
    if (!wanted(command, condition.name)) continue;
    const auto rows = navigation_limits(condition, command.options);
    if (!rows) return complain(rows.error());
    for (const LimitRow& row : *rows)
      fmt::print("| {} | {} | {:.2f} | {:.2f} | {} of {} |\n", condition.name, row.without, row.robust.mean,
                 row.robust.percentile_95, row.answered, row.asked);
    std::fflush(stdout);
  }
  return 0;
}

int run(int argc, char** argv) {
  CLI::App app{"Errors of the navigation on the digital twin, condition by condition."};
  StudyCommand command;
  app.add_option("--seeds", command.options.seeds, "experiments per condition")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--first-seed", command.options.first_seed, "of the first experiment")
      ->capture_default_str();
  app.add_option("--spots", command.options.spots, "per experiment")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--only", command.only, "conditions whose name contains one of these");
  app.add_flag("--limits", command.limits, "take one source of error away at a time instead");
  CLI11_PARSE(app, argc, argv);
  spdlog::set_level(
      spdlog::level::warn);  // every experiment would report its scan in the middle of the table
  return command.limits ? print_limits(command) : print_table(command);
}

}  // namespace
}  // namespace linescope::study

int main(int argc, char** argv) {
  return linescope::study::run(argc, argv);
}
