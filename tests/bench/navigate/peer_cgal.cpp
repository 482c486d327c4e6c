#include <CGAL/Fuzzy_sphere.h>
#include <CGAL/Kd_tree.h>
#include <CGAL/Monge_via_jet_fitting.h>
#include <CGAL/Search_traits_3.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/linear_least_squares_fitting_3.h>

#include "tests/bench/navigate/normal_peers.hpp"

namespace linescope::bench {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Point = Kernel::Point_3;
using Traits = CGAL::Search_traits_3<Kernel>;

class Cgal : public NormalPeer {
 public:
  Cgal(std::span<const Eigen::Vector3f> points, bool jet) : jet_(jet) {
    for (const Eigen::Vector3f& p : points) tree_.insert(Point(p.x(), p.y(), p.z()));
    tree_.build();
  }
  std::string name() const override { return jet_ ? "CGAL jet" : "CGAL plane"; }
  std::optional<Eigen::Vector3d> normal(const Eigen::Vector3d& place, double radius) override {
    found_.clear();
    tree_.search(std::back_inserter(found_),
                 CGAL::Fuzzy_sphere<Traits>(Point(place.x(), place.y(), place.z()), radius));
    if (found_.size() < 10) return std::nullopt;
    return jet_ ? jet_normal(place) : plane_normal();
  }

 private:
  std::optional<Eigen::Vector3d> plane_normal() const {
    Kernel::Plane_3 plane;
    CGAL::linear_least_squares_fitting_3(found_.begin(), found_.end(), plane, CGAL::Dimension_tag<0>());
    const auto n = plane.orthogonal_vector();
    return Eigen::Vector3d(n.x(), n.y(), n.z()).normalized();
  }
  /// The jet is fitted about its first point: the one nearest to the place.
  std::optional<Eigen::Vector3d> jet_normal(const Eigen::Vector3d& place) {
    const Point at(place.x(), place.y(), place.z());
    std::iter_swap(found_.begin(),
                   std::min_element(found_.begin(), found_.end(), [&](const Point& a, const Point& b) {
                     return CGAL::squared_distance(a, at) < CGAL::squared_distance(b, at);
                   }));
    CGAL::Monge_via_jet_fitting<Kernel> fitting;
    const auto form = fitting(found_.begin(), found_.end(), 2, 2);
    const auto n = form.normal_direction();
    return Eigen::Vector3d(n.x(), n.y(), n.z()).normalized();
  }

  bool jet_;
  CGAL::Kd_tree<Traits> tree_;
  std::vector<Point> found_;
};

}  // namespace

std::unique_ptr<NormalPeer> cgal_plane_peer(std::span<const Eigen::Vector3f> points) {
  return std::make_unique<Cgal>(points, false);
}
std::unique_ptr<NormalPeer> cgal_jet_peer(std::span<const Eigen::Vector3f> points) {
  return std::make_unique<Cgal>(points, true);
}

}  // namespace linescope::bench
