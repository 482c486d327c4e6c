// A triangle mesh as plain arrays: what every mesher gives and what display, export and tests take.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace linescope {

/// Where a triangle comes from. Filled triangles close a hole nobody measured: show them in another colour.
enum class TriangleOrigin : std::uint8_t { measured = 0, filled = 1 };

/// Millimetres, in the frame the points were given in (the viewer: the object's frame, sensor 2).
/// The vertex arrays have one entry per vertex, `triangles` and `origin` one per triangle.
/// Triangles run counter-clockwise seen from the outside; for a one-sided surface that is the side it was
/// seen from.
struct TriangleMesh {
  std::vector<Eigen::Vector3f> positions;   ///< mm
  std::vector<Eigen::Vector3f> normals;     ///< unit vectors, to the outside
  std::vector<float> uncertainty;           ///< mm, one standard deviation along the normal; NaN: not known
  std::vector<std::uint32_t> observations;  ///< measured points that carry the vertex; 0 on filled patches
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< vertex indices
  std::vector<TriangleOrigin> origin;

  std::size_t vertex_count() const { return positions.size(); }
  std::size_t triangle_count() const { return triangles.size(); }
  bool empty() const { return triangles.empty(); }
  /// Triangles that close holes.
  std::size_t filled_count() const;

  /// Empties all arrays and keeps their memory.
  void clear();

  /// Sum of the triangles' areas, mm^2.
  double area() const;
};

}  // namespace linescope
