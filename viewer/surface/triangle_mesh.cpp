#include "viewer/surface/triangle_mesh.hpp"

#include <Eigen/Geometry>

namespace linescope {

void TriangleMesh::clear() {
  positions.clear();
  normals.clear();
  uncertainty.clear();
  observations.clear();
  triangles.clear();
  origin.clear();
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
