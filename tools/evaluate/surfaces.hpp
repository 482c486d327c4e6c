// The viewer's meshers and its normal estimator on the lines of a session.
#pragma once

#include <vector>

#include "viewer/navigate/normal_estimator.hpp"
#include "viewer/surface/mesher.hpp"
#include "viewer/view_state.hpp"

namespace linescope::evaluate {

struct Surface {
  TriangleMesh mesh;
  std::vector<Eigen::Vector3f> grid;  ///< the marked vertices behind the thesis's mesh
};

/// With the mesher's default options at the thesis's cubic interval (1.27 mm).
Surface surface_of(const HeldLines& lines, MeshMethod method);

/// Holds the points of all lines, as the viewer's does.
NormalEstimator estimator_of(const HeldLines& lines, const NormalEstimatorOptions& options = {});

/// The columns of the report.
inline constexpr MeshMethod kThesisMesh = MeshMethod::proposed_cubes;
inline constexpr MeshMethod kBetterMesh = MeshMethod::implicit;

}  // namespace linescope::evaluate
