#include <fmt/format.h>

#include <array>
#include <functional>

#include "common/units.hpp"
#include "tools/prism/prism_design.hpp"

namespace linescope {
namespace {

using Column = std::function<std::string(const PrismDesign&)>;

std::string degrees(double radians) {
  return fmt::format("{:.2f} deg", degrees_from_radians(radians));
}

struct Row {
  std::string name;
  Column value;
};

std::vector<Row> angle_rows() {
  return {
      {"n_a", [](const PrismDesign& d) { return fmt::format("{:g}", d.indices.air); }},
      {"n_p", [](const PrismDesign& d) { return fmt::format("{:g}", d.indices.prism); }},
      {"n_w", [](const PrismDesign& d) { return fmt::format("{:g}", d.indices.medium); }},
      {"delta    apex angle", [](const PrismDesign& d) { return degrees(d.apex_rad); }},
      {"theta0   onto face 1", [](const PrismDesign& d) { return degrees(d.angles.theta0); }},
      {"theta0'  behind face 1", [](const PrismDesign& d) { return degrees(d.angles.theta0_prime); }},
      {"theta1   onto face 2", [](const PrismDesign& d) { return degrees(d.angles.theta1); }},
      {"theta1'  behind face 2", [](const PrismDesign& d) { return degrees(d.angles.theta1_prime); }},
      {"theta2   against the axis", [](const PrismDesign& d) { return degrees(d.angles.theta2); }},
      {"gamma    deviation", [](const PrismDesign& d) { return degrees(d.angles.gamma); }},
      {"tau      critical angle",
       [](const PrismDesign& d) { return d.critical_rad ? degrees(*d.critical_rad) : std::string("none"); }},
      {"total reflection",
       [](const PrismDesign& d) {
         return d.critical_rad ? fmt::format("no, {:.2f} deg off",
                                             degrees_from_radians(*d.critical_rad - d.angles.theta1))
                               : std::string("impossible");
       }},
      {"gamma per 0.01 of n_p", [](const PrismDesign& d) { return degrees(0.01 * d.gamma_per_prism_index); }},
      {"gamma per 0.01 of n_w",
       [](const PrismDesign& d) { return degrees(0.01 * d.gamma_per_medium_index); }},
      {"gamma per degree of delta",
       [](const PrismDesign& d) { return degrees(radians_from_degrees(d.gamma_per_apex)); }},
  };
}

std::vector<Row> error_rows() {
  std::vector<Row> rows;
  for (std::size_t i = 0; i < 3; ++i) {
    rows.push_back({fmt::format("sheet as plane, {} mm", 10 + 5 * i), [i](const PrismDesign& d) {
                      if (i >= d.plane_errors.size()) return std::string("--");
                      const twin::PlaneError& e = d.plane_errors[i];
                      return fmt::format("{:+.2f} SD {:.2f} mm", e.mean_mm, e.sd_mm);
                    }});
  }
  return rows;
}

}  // namespace

std::string as_text(const std::vector<PrismDesign>& designs) {
  std::string text;
  std::vector<Row> rows = angle_rows();
  for (Row& row : error_rows()) rows.push_back(std::move(row));
  for (const Row& row : rows) {
    text += fmt::format("{:<28}", row.name);
    for (const PrismDesign& d : designs) text += fmt::format("{:>20}", row.value(d));
    text += '\n';
  }
  return text;
}

std::string as_json(const std::vector<PrismDesign>& designs) {
  std::string list;
  for (const PrismDesign& d : designs) {
    const auto deg = degrees_from_radians;
    std::string errors;
    for (const twin::PlaneError& e : d.plane_errors) {
      errors += fmt::format(R"({}{{"gap_mm":{},"mean_mm":{:.4f},"sd_mm":{:.4f},"worst_mm":{:.4f}}})",
                            errors.empty() ? "" : ",", e.gap_mm, e.mean_mm, e.sd_mm, e.worst_mm);
    }
    list += fmt::format(
        R"({}{{"n_a":{},"n_p":{},"n_w":{},"delta_deg":{:.6f},"theta0_deg":{:.6f},"theta0_prime_deg":{:.6f},)"
        R"("theta1_deg":{:.6f},"theta1_prime_deg":{:.6f},"theta2_deg":{:.6f},"gamma_deg":{:.6f},"tau_deg":{},)"
        R"("gamma_deg_per_n_p":{:.4f},"gamma_deg_per_n_w":{:.4f},"gamma_per_delta":{:.4f},"plane_errors":[{}]}})",
        list.empty() ? "" : ",\n ", d.indices.air, d.indices.prism, d.indices.medium, deg(d.apex_rad),
        deg(d.angles.theta0), deg(d.angles.theta0_prime), deg(d.angles.theta1), deg(d.angles.theta1_prime),
        deg(d.angles.theta2), deg(d.angles.gamma),
        d.critical_rad ? fmt::format("{:.6f}", deg(*d.critical_rad)) : "null", deg(d.gamma_per_prism_index),
        deg(d.gamma_per_medium_index), d.gamma_per_apex, errors);
  }
  return "[" + list + "]\n";
}

Result<std::string> table_33() {
  struct Printed {
    double prism_index, delta, tau;
  };
  constexpr std::array<Printed, 2> kPrinted{{{1.49, 58.20, 63.46}, {1.53, 53.35, 60.60}}};
  std::string text = "n_p     printed delta  tau      n_w     delta    tau\n";
  for (const Printed& printed : kPrinted) {
    for (const double water : {1.33, 1.333}) {
      const auto d = design({{1.0, printed.prism_index, water}, radians_from_degrees(14), {}, 6.0, 0.3});
      if (!d) return tl::unexpected(d.error());
      text += fmt::format("{:<8g}{:>13.2f}{:>7.2f}{:>9.3f}{:>9.2f}{:>9.2f}\n", printed.prism_index,
                          printed.delta, printed.tau, water, degrees_from_radians(d->apex_rad),
                          degrees_from_radians(*d->critical_rad));
    }
  }
  return text + "The printed apex angles belong to n_w = 1.33, the printed critical angles to n_w = 1.333.\n";
}

}  // namespace linescope
