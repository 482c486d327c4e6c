// The thesis's surface: proposed marching cubes (PMC, 4.3.2), and the classical algorithm (CMC, 4.3.1) over
// the same grid.
//
// PMC: every point marks its nearest grid vertex (1, the rest 0); 256-case table; vertices at the midpoints
// of crossed edges. The marked vertices are a solid, so the surface is a closed skin on both sides of what
// was seen. Normals: the sum of the three cross products of Eqs 4.13-4.15 over a triangle P1 P2 P3 does not
// depend on V; it is twice the triangle's area vector. A vertex takes the normalised sum over its triangles.
// CMC: the same cubes with the number of points as density, vertices by linear interpolation (Eqs 4.11-4.12),
// normals by central differences of the densities.
#pragma once

#include "viewer/surface/cube_blocks.hpp"
#include "viewer/surface/line_quantizer.hpp"
#include "viewer/surface/mesher.hpp"
#include "viewer/surface/sweep_tracker.hpp"
#include "viewer/surface/vertex_grid.hpp"

namespace linescope {

class CubesMesher final : public Mesher {
 public:
  /// `options` must be valid (make_mesher checks) and ask for proposed_cubes or classical_cubes.
  explicit CubesMesher(const MesherOptions& options);

  void begin_sweep() override { sweeps_.request(); }
  void add_line(const SurfaceLine& line) override;
  bool remove_last_sweep() override;
  void clear() override;
  void update() override { cubes_.update(grid_); }
  void write_mesh(TriangleMesh& mesh) override;
  std::vector<Eigen::Vector3f> grid_vertices() override;
  MesherCounters counters() const override { return counters_; }
  MesherState state() override;
  const MesherOptions& options() const override { return options_; }

 private:
  void place_vertices(TriangleMesh& mesh);
  void place_vertex(std::int32_t block, int axis, int local, TriangleMesh& mesh) const;
  void connect_triangles(TriangleMesh& mesh);
  std::uint32_t vertex_number(std::int32_t block, EdgeCode edge) const;
  Eigen::Vector3f density_gradient(std::int32_t block, GridIndex at) const;
  bool classical() const { return options_.method == MeshMethod::classical_cubes; }

  MesherOptions options_;
  SweepTracker sweeps_;
  LineQuantizer quantizer_;
  std::vector<std::uint32_t> tile_;  // all zero between lines
  VertexGrid grid_;
  CubeBlocks cubes_;
  MesherCounters counters_;
  std::vector<std::uint32_t> first_vertex_;  // per block, of the mesh being written
};

}  // namespace linescope
