// Triangles of a distance field, cut off at the border of what was seen.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "viewer/surface/distance_field.hpp"
#include "viewer/surface/triangle_mesh.hpp"

namespace linescope {

/// Marching cubes over the field's cubes. Triangles that reach beyond the border are clipped along the line
/// where the vertices' support is zero; neighbouring triangles share the cut points.
class SurfaceExtractor {
 public:
  explicit SurfaceExtractor(double interval) : interval_(interval) {}

  void extract(DistanceField& field, TriangleMesh& mesh);

 private:
  using Triangle = std::array<std::uint32_t, 3>;

  void add_cube(const DistanceField& field, const FieldVertex& low, TriangleMesh& mesh);
  std::uint32_t edge_vertex(const DistanceField& field, const std::array<std::int32_t, 8>& corners, int edge,
                            TriangleMesh& mesh);
  void add_between(const FieldVertex& low, const FieldVertex& high, TriangleMesh& mesh);
  void add_clipped(const Triangle& triangle, TriangleMesh& mesh);
  std::uint32_t cut_point(std::uint32_t a, std::uint32_t b, TriangleMesh& mesh);
  void drop_unused_vertices(TriangleMesh& mesh);

  double interval_;
  std::vector<std::array<std::int32_t, 3>> on_edge_;  // per field vertex and axis: vertex of the mesh or -1
  std::vector<float> support_;                        // per vertex of the mesh
  std::unordered_map<std::uint64_t, std::uint32_t> cuts_;
  std::vector<std::uint32_t> new_number_;
  bool clipped_ = false;
};

}  // namespace linescope
