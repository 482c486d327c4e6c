#include "viewer/surface/triangle_mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace linescope {

void TriangleMesh::clear() {
  positions.clear();
  normals.clear();
  uncertainty.clear();
  observations.clear();
  triangles.clear();
  origin.clear();
}

std::size_t TriangleMesh::filled_count() const {
  return static_cast<std::size_t>(std::count(origin.begin(), origin.end(), TriangleOrigin::filled));
}

double TriangleMesh::area() const {
  double sum = 0;
  for (const auto& [a, b, c] : triangles) {
    const Eigen::Vector3d p = positions[a].cast<double>();
    sum += 0.5 * (positions[b].cast<double>() - p).cross(positions[c].cast<double>() - p).norm();
  }
  return sum;
}

}  // namespace linescope
