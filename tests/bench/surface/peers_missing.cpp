#include "tests/bench/surface/peers.hpp"

namespace linescope::bench {

#ifdef LINESCOPE_NO_CGAL
std::vector<Peer> cgal_peers(std::span<const Eigen::Vector3f>, double) {
  return {};
}
#endif
#ifdef LINESCOPE_NO_PCL
std::vector<Peer> pcl_peers(std::span<const Eigen::Vector3f>, double) {
  return {};
}
#endif
#ifdef LINESCOPE_NO_OPEN3D
std::vector<Peer> open3d_peers(std::span<const Eigen::Vector3f>, double) {
  return {};
}
#endif

}  // namespace linescope::bench
