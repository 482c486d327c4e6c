#include "tools/evaluate/surfaces.hpp"

#include "viewer/held_line.hpp"

namespace linescope::evaluate {

Surface surface_of(const HeldLines& lines, MeshMethod method) {
  MesherOptions options;
  options.method = method;
  const auto mesher = *make_mesher(options);
  for (const auto& line : lines) mesher->add_line(surface_line(*line));
  Surface surface;
  mesher->write_mesh(surface.mesh);
  surface.grid = mesher->grid_vertices();
  return surface;
}

NormalEstimator estimator_of(const HeldLines& lines, const NormalEstimatorOptions& options) {
  NormalEstimator estimator(options);
  for (const auto& line : lines)
    if (!line->points.empty()) estimator.add_line(navigation_line(*line));
  return estimator;
}

}  // namespace linescope::evaluate
