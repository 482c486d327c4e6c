#include "tools/evaluate/surfaces.hpp"

namespace linescope::evaluate {

Surface surface_of(const HeldLines& lines, MeshMethod method) {
  MesherOptions options;
  options.method = method;
  const auto mesher = *make_mesher(options);
  for (const auto& line : lines) {
    mesher->add_line(
        {.points = line->points, .seen_from = line->seen_from, .time = line->time, .id = line->serial});
  }
  Surface surface;
  mesher->write_mesh(surface.mesh);
  surface.grid = mesher->grid_vertices();
  return surface;
}

}  // namespace linescope::evaluate
