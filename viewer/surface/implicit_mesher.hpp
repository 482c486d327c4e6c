// The better mesher: a one-sided surface from local fits to moments, open at the border of what was seen.
//
// points -> moments per cube (MomentGrid) -> patches, one per column of cubes (PatchMap) -> signed distances
// at grid vertices (DistanceField) -> triangles (SurfaceExtractor). Every stage redoes only what depends on
// cubes a line touched. Method, choice and figures: docs/surface.md.
#pragma once

#include "viewer/surface/distance_field.hpp"
#include "viewer/surface/line_quantizer.hpp"
#include "viewer/surface/mesher.hpp"
#include "viewer/surface/moment_grid.hpp"
#include "viewer/surface/patch_map.hpp"
#include "viewer/surface/surface_extractor.hpp"
#include "viewer/surface/sweep_tracker.hpp"

namespace linescope {

class ImplicitMesher final : public Mesher {
 public:
  /// `options` must be valid (make_mesher checks).
  explicit ImplicitMesher(const MesherOptions& options);

  void begin_sweep() override { sweeps_.request(); }
  void add_line(const SurfaceLine& line) override;
  bool remove_last_sweep() override;
  void clear() override;
  void update() override;
  void write_mesh(TriangleMesh& mesh) override;
  std::vector<Eigen::Vector3f> grid_vertices() override;
  MesherCounters counters() const override { return counters_; }
  MesherState state() override;
  std::optional<HoleCounts> holes() const override;
  const MesherOptions& options() const override { return options_; }

 private:
  MesherOptions options_;
  SweepTracker sweeps_;
  LineQuantizer quantizer_;
  MomentGrid moments_;
  PatchMap patches_;
  DistanceField field_;
  SurfaceExtractor extractor_;
  MesherCounters counters_;
  HoleCounts holes_;
};

}  // namespace linescope
