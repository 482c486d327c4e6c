// linescope-prism: the designer of the prism at the endoscope's tip (thesis 3.5.1).
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>

#include "common/exit_code.hpp"
#include "common/units.hpp"
#include "tools/prism/prism_design.hpp"

namespace linescope {
namespace {

struct PrismCommand {
  twin::PrismIndices indices;
  std::vector<double> prism_indices{1.49, 1.53};
  double deviation_deg = 14;
  double apex_deg = 0;  ///< 0: from the deviation
  double baseline_mm = 6;
  double fan_deg = degrees_from_radians(0.3);
  bool table = false;
  bool json = false;
  std::string svg;
};

void declare(CLI::App& app, PrismCommand& c) {
  app.add_option("--air", c.indices.air, "n_a, index in front of the prism")->capture_default_str();
  app.add_option("--prism", c.prism_indices, "n_p, one or several")->capture_default_str();
  app.add_option("--water", c.indices.medium, "n_w, index behind the prism")->capture_default_str();
  auto* deviation = app.add_option("--deviation", c.deviation_deg, "gamma, wanted deviation, degrees")
                        ->capture_default_str();
  app.add_option("--apex", c.apex_deg, "delta of a given prism, degrees, instead of a wanted deviation")
      ->check(CLI::Range(0.01, 89.99))
      ->excludes(deviation);
  app.add_option("--baseline", c.baseline_mm, "b, mm, for the depth error of a plane")
      ->check(CLI::Range(0.01, 200.0))
      ->capture_default_str();
  app.add_option("--fan", c.fan_deg, "half angle of the fan in the medium, degrees, for the same")
      ->check(CLI::Range(1.0, 60.0))
      ->capture_default_str();
  app.add_flag("--table", c.table, "Table 3.3 of the thesis, printed and computed");
  app.add_flag("--json", c.json, "for machines");
  app.add_option("--svg", c.svg, "draw the ray's path (of the last n_p) into this file");
  app.footer("Exit code: 0 done, 1 no such prism or file not written, 2 wrong usage.");
}

Result<std::vector<PrismDesign>> designs(const PrismCommand& c) {
  std::vector<PrismDesign> all;
  for (const double index : c.prism_indices) {
    PrismRequest request;
    request.indices = {c.indices.air, index, c.indices.medium};
    request.deviation_rad = radians_from_degrees(c.deviation_deg);
    if (c.apex_deg > 0) request.apex_rad = radians_from_degrees(c.apex_deg);
    request.baseline_mm = c.baseline_mm;
    request.fan_half_angle_rad = radians_from_degrees(c.fan_deg);
    auto made = design(request);
    if (!made)
      return tl::unexpected(
          Error{made.error().code, fmt::format("n_p = {:g}: {}", index, made.error().message)});
    all.push_back(*made);
  }
  return all;
}

Result<void> write_svg(const PrismDesign& design, const std::string& file) {
  std::ofstream stream(file);
  stream << as_svg(design);
  stream.close();
  if (stream) return {};
  return fail(ErrorCode::permission, fmt::format("the drawing cannot be written to {}", file));
}

Result<void> run(const PrismCommand& c) {
  if (c.table) {
    const auto table = table_33();
    if (!table) return tl::unexpected(table.error());
    std::fputs(table->c_str(), stdout);
    return {};
  }
  const auto all = designs(c);
  if (!all) return tl::unexpected(all.error());
  std::fputs((c.json ? as_json(*all) : as_text(*all)).c_str(), stdout);
  return c.svg.empty() ? Result<void>{} : write_svg(all->back(), c.svg);
}

}  // namespace
}  // namespace linescope

int main(int argc, char** argv) {
  using namespace linescope;
  CLI::App app{"Designs the prism that turns the laser sheet towards the camera's axis", "linescope-prism"};
  PrismCommand command;
  declare(app, command);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? exit_status(ExitCode::ok) : exit_status(ExitCode::usage);
  }
  const auto done = run(command);
  if (done) return exit_status(ExitCode::ok);
  std::fprintf(stderr, "linescope-prism: %s\n", done.error().message.c_str());
  return exit_status(ExitCode::failed);
}
