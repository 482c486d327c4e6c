#include <open3d/geometry/KDTreeFlann.h>
#include <open3d/geometry/PointCloud.h>
#include <open3d/utility/Eigen.h>

#include <Eigen/Eigenvalues>

#include "tests/bench/navigate/normal_peers.hpp"

namespace linescope::bench {
namespace {

class Open3d : public NormalPeer {
 public:
  explicit Open3d(std::span<const Eigen::Vector3f> points) {
    for (const Eigen::Vector3f& p : points) cloud_.points_.push_back(p.cast<double>());
    tree_.SetGeometry(cloud_);
  }
  std::string name() const override { return "Open3D"; }
  std::optional<Eigen::Vector3d> normal(const Eigen::Vector3d& place, double radius) override {
    if (tree_.SearchRadius(place, radius, indices_, squares_) < 3) return std::nullopt;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(open3d::utility::ComputeCovariance(cloud_.points_, indices_));
    return solver.eigenvectors().col(0);
  }

 private:
  open3d::geometry::PointCloud cloud_;
  open3d::geometry::KDTreeFlann tree_;
  std::vector<int> indices_;
  std::vector<double> squares_;
};

}  // namespace

std::unique_ptr<NormalPeer> open3d_peer(std::span<const Eigen::Vector3f> points) {
  return std::make_unique<Open3d>(points);
}

}  // namespace linescope::bench
