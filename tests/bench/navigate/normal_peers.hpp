// Other people's ways to a normal at a place: each holds its own index of the same points.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace linescope::bench {

class NormalPeer {
 public:
  virtual ~NormalPeer() = default;
  virtual std::string name() const = 0;
  /// From the points within `radius` of `place`, mm; no preferred side. Nothing where there are too few.
  virtual std::optional<Eigen::Vector3d> normal(const Eigen::Vector3d& place, double radius) = 0;
};

/// Radius search, then the plane of least squares (PCA).
std::unique_ptr<NormalPeer> nanoflann_peer(std::span<const Eigen::Vector3f> points);
/// KdTreeFLANN and computePointNormal.
std::unique_ptr<NormalPeer> pcl_peer(std::span<const Eigen::Vector3f> points);
/// KDTreeFlann and the eigenvector of the covariance, as EstimateNormals does.
std::unique_ptr<NormalPeer> open3d_peer(std::span<const Eigen::Vector3f> points);
/// Kd_tree with Fuzzy_sphere, then linear_least_squares_fitting_3, or a jet of degree 2.
std::unique_ptr<NormalPeer> cgal_plane_peer(std::span<const Eigen::Vector3f> points);
std::unique_ptr<NormalPeer> cgal_jet_peer(std::span<const Eigen::Vector3f> points);

/// All that this build has.
std::vector<std::unique_ptr<NormalPeer>> all_peers(std::span<const Eigen::Vector3f> points);

}  // namespace linescope::bench
