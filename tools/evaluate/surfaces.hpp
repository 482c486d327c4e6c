// The viewer's meshers on the lines of a session.
#pragma once

#include <vector>

#include "viewer/surface/mesher.hpp"
#include "viewer/view_state.hpp"

namespace linescope::evaluate {

struct Surface {
  TriangleMesh mesh;
  std::vector<Eigen::Vector3f> grid;  ///< the marked vertices behind the thesis's mesh
};

/// With the mesher's default options at the thesis's cubic interval (1.27 mm).
Surface surface_of(const HeldLines& lines, MeshMethod method);

/// The columns of the report.
inline constexpr MeshMethod kThesisMesh = MeshMethod::proposed_cubes;
inline constexpr MeshMethod kBetterMesh = MeshMethod::implicit;

}  // namespace linescope::evaluate
