#include <fmt/format.h>

#include <array>

#include "acquire/twin/prism.hpp"
#include "acquire/twin/sheet_bend.hpp"
#include "common/units.hpp"
#include "tools/evaluate/sections.hpp"
#include "tools/evaluate/setups.hpp"

namespace linescope::evaluate {
namespace {

constexpr double kDeviation = radians_from_degrees(14);

struct PrintedPrism {
  double index, apex_deg, critical_deg;
};
constexpr std::array kPrinted{PrintedPrism{1.49, 58.20, 63.46}, PrintedPrism{1.53, 53.35, 60.60}};

std::optional<Estimate> single(double value) {
  return estimate({value});
}

Result<Table> prism_table() {
  Table table{"prism", "Table 3.3: the prism, gamma 14 degrees", {}, {}};
  for (const PrintedPrism& printed : kPrinted) {
    for (const double water : {1.33, 1.333}) {
      const twin::PrismIndices indices{1.0, printed.index, water};
      auto apex = twin::apex_for_deviation(indices, kDeviation);
      if (!apex) return tl::unexpected(apex.error());
      auto critical = twin::critical_angle(indices);
      if (!critical) return tl::unexpected(critical.error());
      const auto name = [&](const char* what) {
        return fmt::format("n_p {:g}, n_w {:g}: {}", printed.index, water, what);
      };
      table.rows.push_back(
          {name("apex angle"), "deg", printed.apex_deg, single(degrees_from_radians(*apex)), {}});
      table.rows.push_back(
          {name("critical angle"), "deg", printed.critical_deg, single(degrees_from_radians(*critical)), {}});
    }
  }
  table.notes = {
      "The printed apex angles belong to n_w = 1.33, the printed critical angles to n_w = 1.333: two water "
      "indices were mixed (docs/prism.md)."};
  return table;
}

Result<Table> bent_sheet_table() {
  auto errors = twin::plane_errors(with_bent_sheet(system_ii(1)), {10, 15, 20});
  if (!errors) return tl::unexpected(errors.error());
  Table table{"bent-sheet", "The sheet behind the prism taken for a plane: systematic depth error", {}, {}};
  for (const twin::PlaneError& e : *errors) {
    const auto name = [&](const char* what) { return fmt::format("gap {:g} mm: {}", e.gap_mm, what); };
    table.rows.push_back({name("mean along the line"), "mm", {}, single(e.mean_mm), {}});
    table.rows.push_back({name("SD along the line"), "mm", {}, single(e.sd_mm), {}});
    table.rows.push_back({name("worst within the fan"), "mm", {}, single(e.worst_mm), {}});
  }
  table.notes = {
      "No noise: every ray of the fan traced through the prism (n_p 1.53, n_w 1.33), met with the best "
      "plane, on a "
      "wall across the optical axis; weighted with the line's light, half angle 0.3 rad (10 mm of line at 15 "
      "mm). "
      "The thesis does not mention it."};
  return table;
}

}  // namespace

Sections prism_sections(const Form&) {
  auto prism = prism_table();
  if (!prism) return tl::unexpected(prism.error());
  auto bent = bent_sheet_table();
  if (!bent) return tl::unexpected(bent.error());
  return std::vector<Section>{{std::move(*prism), {}}, {std::move(*bent), {}}};
}

}  // namespace linescope::evaluate
