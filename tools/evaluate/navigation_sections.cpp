#include <cmath>

#include "common/units.hpp"
#include "tools/evaluate/figures.hpp"
#include "tools/evaluate/navigation_study.hpp"
#include "tools/evaluate/sections.hpp"
#include "tools/evaluate/seed_values.hpp"

namespace linescope::evaluate {
namespace {

// Section 5.3.2; freehand: reference [30] of the thesis.
constexpr GroupSummary kThesisNavigated{9.5, 2.86, 30};
constexpr GroupSummary kFreehandHarvest{14.8, 7.53, 20};
constexpr GroupSummary kFreehandRecipient{12.6, 3.98, 20};

using Value = double (*)(const SpotReport&);

struct RowOfSpots {
  Row row;
  Value value;
};

double degrees(double radians) {
  return degrees_from_radians(radians);
}

const std::vector<RowOfSpots>& spot_rows() {
  static const std::vector<RowOfSpots> rows{
      {{"error of the normal: mean", "deg", 9.5, {}, {}},
       [](const SpotReport& r) { return degrees(r.mean); }},
      {{"error of the normal: SD", "deg", 2.86, {}, {}},
       [](const SpotReport& r) { return degrees(r.deviation); }},
      {{"error of the normal: smallest", "deg", 5, {}, {}, 1},
       [](const SpotReport& r) { return degrees(r.smallest); }},
      {{"error of the normal: largest", "deg", 17, {}, {}, 1},
       [](const SpotReport& r) { return degrees(r.largest); }},
      {{"spots answered", "", 30, {}, {}, 1},
       [](const SpotReport& r) { return static_cast<double>(r.answered); }},
      {{"stated 95 % cone holds the true normal", "%", {}, {}, {}, 0},
       [](const SpotReport& r) { return r.mean_uncertainty > 0 ? 100 * r.cone_coverage : std::nan(""); }},
      {{"stated 95 % interval holds the true angle", "%", {}, {}, {}, 0}, [](const SpotReport& r) {
         return r.mean_uncertainty > 0 ? 100 * r.interval_coverage : std::nan("");
       }}};
  return rows;
}

SeedValues values_of(const NavigationOutcome& outcome) {
  SeedValues values;
  for (const RowOfSpots& row : spot_rows())
    values.push_back({row.value(outcome.plain), row.value(outcome.better)});
  return values;
}

Table navigation_table(const std::vector<NavigationOutcome>& outcomes) {
  Table table{"navigation", "Section 5.3: navigation, 50 mm cylinder in water", {}, {}};
  for (const RowOfSpots& row : spot_rows()) table.rows.push_back(row.row);
  std::vector<SeedValues> seeds;
  for (const NavigationOutcome& outcome : outcomes) seeds.push_back(values_of(outcome));
  fill_rows(table.rows, seeds);
  table.notes = {
      "Each seed is one experiment of 30 spots with a scan of its own. The error is the angle between the "
      "normal the system states and the true one, where the harvester's axis meets the surface.",
      "Algorithm 1 states no uncertainty: the two rows on the stated 95 % are those of the robust estimate."};
  return table;
}

/// What a paper would print of one of our experiments: means over the seeds.
GroupSummary summary(const Row& mean, const Row& deviation, bool better) {
  const auto& m = better ? mean.better : mean.plain;
  const auto& d = better ? deviation.better : deviation.plain;
  return {m ? m->mean : 0, d ? d->mean : 0, 30};
}

Estimate single(double value) {
  return *estimate({value});
}

Row test_row(const char* what, double thesis_p, const GroupSummary& plain, const GroupSummary& better,
             const GroupSummary& freehand) {
  return {what,
          "",
          thesis_p,
          single(pooled_student(plain, freehand).p),
          single(pooled_student(better, freehand).p),
          5};
}

Row thesis_test_row(const char* what, double printed, const GroupSummary& freehand) {
  return {what, "", printed, single(pooled_student(kThesisNavigated, freehand).p), {}, 5};
}

Table comparison_table(const Table& navigation) {
  const GroupSummary plain = summary(navigation.rows[0], navigation.rows[1], false);
  const GroupSummary better = summary(navigation.rows[0], navigation.rows[1], true);
  Table table{"comparison", "Section 5.3.2: against freehand, pooled Student test, P", {}, {}};
  table.rows = {
      thesis_test_row("thesis's own summary against harvest (14.8, SD 7.53, N 20)", 0.001, kFreehandHarvest),
      thesis_test_row("thesis's own summary against recipient (12.6, SD 3.98, N 20)", 0.0024,
                      kFreehandRecipient),
      test_row("ours against harvest", 0.001, plain, better, kFreehandHarvest),
      test_row("ours against recipient", 0.0024, plain, better, kFreehandRecipient)};
  table.notes = {
      "The first two rows put the thesis's printed means and standard deviations (9.5, SD 2.86, N 30) into "
      "our "
      "test: they reproduce its P. The other rows use the mean error and SD of the table above with N = 30; "
      "they "
      "compare a simulated operator, who holds the harvester on the spot, with people at work, and say only "
      "what "
      "the instrument adds."};
  return table;
}

std::vector<double> errors_in_degrees(const std::vector<NavigationOutcome>& outcomes, bool better) {
  std::vector<double> errors;
  for (const NavigationOutcome& outcome : outcomes)
    for (const SpotResult& spot : (better ? outcome.better : outcome.plain).spots)
      if (spot.reason == NormalReason::none) errors.push_back(degrees(spot.normal_error));
  return errors;
}

}  // namespace

Sections navigation_sections(const Form& form) {
  auto outcomes = for_each_seed<NavigationOutcome>(
      form, [&](std::uint64_t seed) { return navigation_experiment(form, seed); });
  if (!outcomes) return tl::unexpected(outcomes.error());
  Table navigation = navigation_table(*outcomes);
  Table comparison = comparison_table(navigation);
  std::vector<Figure> figures{
      navigation_boxes_figure(errors_in_degrees(*outcomes, false), errors_in_degrees(*outcomes, true))};
  return std::vector<Section>{{std::move(navigation), std::move(figures)}, {std::move(comparison), {}}};
}

}  // namespace linescope::evaluate
