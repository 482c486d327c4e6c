#include "tools/evaluate/sections.hpp"

namespace linescope::evaluate {

const std::vector<SectionMaker>& section_makers() {
  static const std::vector<SectionMaker> makers{
      {"noise-free", noise_free_sections}, {"plane", plane_sections},  {"air", air_sections},
      {"cylinder", cylinder_sections},     {"site", site_sections},    {"navigation", navigation_sections},
      {"prism", prism_sections},           {"timing", timing_sections}};
  return makers;
}

}  // namespace linescope::evaluate
