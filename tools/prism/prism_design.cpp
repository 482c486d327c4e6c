#include "tools/prism/prism_design.hpp"

#include <cmath>

namespace linescope {
namespace {

// Derivatives of Eq 3.9, gamma = asin(n_p sin(delta) / n_w) - delta.
void add_slopes(PrismDesign& d) {
  const double n_p = d.indices.prism, n_w = d.indices.medium;
  const double cosine = std::cos(d.angles.theta1_prime);
  d.gamma_per_prism_index = std::sin(d.apex_rad) / (n_w * cosine);
  d.gamma_per_medium_index = -n_p * std::sin(d.apex_rad) / (n_w * n_w * cosine);
  d.gamma_per_apex = n_p * std::cos(d.apex_rad) / (n_w * cosine) - 1;
}

void add_plane_errors(PrismDesign& d, const PrismRequest& request) {
  twin::TwinOptions options = twin::demo_twin();
  options.instrument.baseline_mm = request.baseline_mm;
  options.instrument.alpha_rad = d.angles.gamma;
  options.optics.line.fan_half_angle_rad = request.fan_half_angle_rad;
  options.optics.prism = {true, d.indices.air, d.indices.prism, d.indices.medium};
  if (auto errors = twin::plane_errors(options, {10, 15, 20})) d.plane_errors = *errors;
}

}  // namespace

Result<PrismDesign> design(const PrismRequest& request) {
  PrismDesign d;
  d.indices = request.indices;
  if (request.apex_rad) {
    d.apex_rad = *request.apex_rad;
  } else {
    const auto apex = twin::apex_for_deviation(request.indices, request.deviation_rad);
    if (!apex) return tl::unexpected(apex.error());
    d.apex_rad = *apex;
  }
  const auto angles = twin::prism_angles(d.indices, d.apex_rad);
  if (!angles) return tl::unexpected(angles.error());
  d.angles = *angles;
  if (auto critical = twin::critical_angle(d.indices)) d.critical_rad = *critical;
  add_slopes(d);
  add_plane_errors(d, request);
  return d;
}

}  // namespace linescope
