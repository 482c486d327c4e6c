// The sections of the report, one file each.
#pragma once

#include <string_view>
#include <vector>

#include "tools/evaluate/form.hpp"
#include "tools/evaluate/report.hpp"

namespace linescope::evaluate {

using Sections = Result<std::vector<Section>>;

Sections noise_free_sections(const Form& form);  ///< what the chain itself loses
Sections plane_sections(const Form& form);       ///< Table 4.1, with the flat and with the bent sheet
Sections air_sections(const Form& form);         ///< system I: plane in air
Sections cylinder_sections(
    const Form& form);                     ///< circle fits (Eq 4.16); mesh against source (Eqs 4.18, 4.19)
Sections site_sections(const Form& form);  ///< condyle and mini knee
Sections navigation_sections(const Form& form);  ///< 30 spots, and against the freehand groups
Sections prism_sections(const Form& form);       ///< Table 3.3, and the bent sheet taken for a plane
Sections timing_sections(const Form& form);      ///< Fig 5.6; the one whose figures are never the same

/// In the order of the report.
struct SectionMaker {
  std::string_view id;  ///< what --only knows
  Sections (*make)(const Form&);
};
const std::vector<SectionMaker>& section_makers();

}  // namespace linescope::evaluate
