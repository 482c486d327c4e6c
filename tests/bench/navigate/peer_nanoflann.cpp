#include <nanoflann.hpp>

#include "tests/bench/navigate/normal_peers.hpp"
#include "viewer/navigate/moments.hpp"

namespace linescope::bench {
namespace {

struct Adaptor {
  std::span<const Eigen::Vector3f> points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  float kdtree_get_pt(std::size_t i, std::size_t d) const { return points[i][static_cast<Eigen::Index>(d)]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

class Nanoflann : public NormalPeer {
 public:
  explicit Nanoflann(std::span<const Eigen::Vector3f> points)
      : adaptor_{points}, tree_(3, adaptor_, nanoflann::KDTreeSingleIndexAdaptorParams(10)) {
    tree_.buildIndex();
  }
  std::string name() const override { return "nanoflann"; }
  std::optional<Eigen::Vector3d> normal(const Eigen::Vector3d& place, double radius) override {
    const Eigen::Vector3f q = place.cast<float>();
    nanoflann::SearchParams parameters;
    parameters.sorted = false;
    tree_.radiusSearch(q.data(), static_cast<float>(radius * radius), found_, parameters);
    Moments sum;
    for (const auto& match : found_) sum.add((adaptor_.points[match.first] - q).cast<double>());
    const auto plane = plane_through(sum);
    return plane ? std::optional<Eigen::Vector3d>(plane->normal) : std::nullopt;
  }

 private:
  Adaptor adaptor_;
  nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Adaptor>, Adaptor, 3, std::uint32_t>
      tree_;
  std::vector<std::pair<std::uint32_t, float>> found_;
};

}  // namespace

std::unique_ptr<NormalPeer> nanoflann_peer(std::span<const Eigen::Vector3f> points) {
  return std::make_unique<Nanoflann>(points);
}

std::vector<std::unique_ptr<NormalPeer>> all_peers(std::span<const Eigen::Vector3f> points) {
  std::vector<std::unique_ptr<NormalPeer>> peers;
  peers.push_back(nanoflann_peer(points));
#ifdef LINESCOPE_HAS_PCL
  peers.push_back(pcl_peer(points));
#endif
#ifdef LINESCOPE_HAS_OPEN3D
  peers.push_back(open3d_peer(points));
#endif
#ifdef LINESCOPE_HAS_CGAL
  peers.push_back(cgal_plane_peer(points));
  peers.push_back(cgal_jet_peer(points));
#endif
  return peers;
}

}  // namespace linescope::bench
