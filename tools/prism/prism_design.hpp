// One prism for the endoscope's tip, worked out (thesis 3.5.1).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "acquire/twin/prism.hpp"
#include "acquire/twin/sheet_bend.hpp"
#include "common/result.hpp"

namespace linescope {

struct PrismRequest {
  twin::PrismIndices indices;
  double deviation_rad = 0;         ///< wanted; not used when an apex is given
  std::optional<double> apex_rad;   ///< a given prism instead of a wanted deviation
  double baseline_mm = 6.0;         ///< for the depth error
  double fan_half_angle_rad = 0.3;  ///< in the medium, for the depth error
};

struct PrismDesign {
  twin::PrismIndices indices;
  double apex_rad = 0;                 ///< delta
  twin::PrismAngles angles;            ///< of the beam that enters at right angles
  std::optional<double> critical_rad;  ///< tau; nothing when the medium is the denser one
  // Change of gamma with what is never exact.
  double gamma_per_prism_index = 0;            ///< rad per 1
  double gamma_per_medium_index = 0;           ///< rad per 1
  double gamma_per_apex = 0;                   ///< rad per rad
  std::vector<twin::PlaneError> plane_errors;  ///< at 10, 15, 20 mm; empty when the sheet cannot be traced
};

/// Fails with one sentence for impossible indices, a deviation that no apex gives, and total reflection.
Result<PrismDesign> design(const PrismRequest& request);

/// A table for people, one column per design. At least one design.
std::string as_text(const std::vector<PrismDesign>& designs);

/// The same for machines: an array of objects, angles in degrees.
std::string as_json(const std::vector<PrismDesign>& designs);

/// Table 3.3 as printed beside what the equations give for both water indices.
Result<std::string> table_33();

/// The ray's path through the prism as an SVG picture.
std::string as_svg(const PrismDesign& design);

}  // namespace linescope
