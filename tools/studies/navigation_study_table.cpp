#include <fmt/format.h>

#include "tools/studies/navigation_study.hpp"

namespace linescope::study {
namespace {

std::string share(int part, int whole) {
  return whole > 0 ? fmt::format("{:.1f}", 100.0 * part / whole) : "-";
}

}  // namespace

std::string refusals_text(const StudyErrors& errors) {
  std::string text;
  for (std::size_t i = 0; i < errors.refused.size(); ++i) {
    if (errors.refused[i] == 0) continue;
    if (!text.empty()) text += ", ";
    text += fmt::format("{} {}", name(static_cast<NormalReason>(i)), errors.refused[i]);
  }
  return text;
}

std::string navigation_table_head() {
  return "| condition | lines | answered | ours: mean | 95 % | largest | shown angle | cone holds % | "
         "interval holds % "
         "| width | Algorithm 1: mean | range | mesh: mean | refused |\n"
         "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
}

std::string navigation_table_line(const NavigationRow& row) {
  const ErrorSummary ours = summary(row.robust.normal_error), shown = summary(row.robust.angle_error);
  const ErrorSummary thesis = summary(row.algorithm_1.normal_error), mesh = summary(row.mesh.normal_error);
  const int answered = row.robust.answered();
  return fmt::format(
      "| {} | {:.0f} | {} of {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {} | {} | {:.2f} | {:.2f} | "
      "{:.1f}-{:.1f} | {:.2f} "
      "| {} |\n",
      row.name, row.lines, answered, row.robust.asked, ours.mean, ours.percentile_95, ours.largest,
      shown.mean, share(row.robust.cone_holds, answered), share(row.robust.interval_holds, answered),
      answered > 0 ? row.robust.interval_width / answered : 0.0, thesis.mean, thesis.smallest, thesis.largest,
      mesh.mean, refusals_text(row.robust));
}

}  // namespace linescope::study
