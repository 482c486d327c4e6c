// Other people's ways from points to triangles, each with its input prepared outside the timing.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "viewer/surface/triangle_mesh.hpp"

namespace linescope::bench {

struct Peer {
  std::string name;
  std::function<void()> run;  ///< points to triangles; the timed part
  std::function<TriangleMesh()>
      mesh;           ///< positions and triangles of the last run; empty where the step makes no mesh
  bool slow = false;  ///< takes so long that it runs in one round only
};

/// `cell` in mm: the interval the surface is asked for.
std::vector<Peer> vtk_peers(std::span<const Eigen::Vector3f> points, double cell);
std::vector<Peer> cgal_peers(std::span<const Eigen::Vector3f> points, double cell);
std::vector<Peer> pcl_peers(std::span<const Eigen::Vector3f> points, double cell);
std::vector<Peer> open3d_peers(std::span<const Eigen::Vector3f> points, double cell);

}  // namespace linescope::bench
