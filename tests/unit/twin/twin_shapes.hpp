// Meshes for the tests, and a slow search that needs no tree.
#pragma once

#include <Eigen/Core>

#include "acquire/twin/phantom_kind.hpp"

namespace linescope::twin {

/// A cube whose sides are divided `2^levels` times and blown up to a sphere around the origin. Closed,
/// outwards.
TriangleSoup sphere_of_triangles(double radius, int levels);

/// Smallest positive distance at which the ray meets a triangle's plane inside the triangle; -1 when it meets
/// none.
double nearest_hit_by_search(const TriangleSoup& soup, const Eigen::Vector3d& from,
                             const Eigen::Vector3d& way);

}  // namespace linescope::twin
