#include <pcl/features/normal_3d.h>
#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include "tests/bench/navigate/normal_peers.hpp"

namespace linescope::bench {
namespace {

class Pcl : public NormalPeer {
 public:
  explicit Pcl(std::span<const Eigen::Vector3f> points) : cloud_(new pcl::PointCloud<pcl::PointXYZ>) {
    for (const Eigen::Vector3f& p : points) cloud_->push_back({p.x(), p.y(), p.z()});
    tree_.setInputCloud(cloud_);
    tree_.setSortedResults(false);
  }
  std::string name() const override { return "PCL"; }
  std::optional<Eigen::Vector3d> normal(const Eigen::Vector3d& place, double radius) override {
    const Eigen::Vector3f q = place.cast<float>();
    tree_.radiusSearch({q.x(), q.y(), q.z()}, radius, indices_, squares_);
    Eigen::Vector4f plane;
    float curvature = 0;
    if (!pcl::computePointNormal(*cloud_, indices_, plane, curvature)) return std::nullopt;
    return plane.head<3>().cast<double>();
  }

 private:
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud_;
  pcl::KdTreeFLANN<pcl::PointXYZ> tree_;
  pcl::Indices indices_;
  std::vector<float> squares_;
};

}  // namespace

std::unique_ptr<NormalPeer> pcl_peer(std::span<const Eigen::Vector3f> points) {
  return std::make_unique<Pcl>(points);
}

}  // namespace linescope::bench
