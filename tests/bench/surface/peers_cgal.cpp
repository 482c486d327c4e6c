#include <CGAL/Advancing_front_surface_reconstruction.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/grid_simplify_point_set.h>

#include <memory>

#include "tests/bench/surface/peers.hpp"

namespace linescope::bench {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

struct CgalInput {
  std::vector<Kernel::Point_3> cloud, used;
  std::vector<std::array<std::size_t, 3>> triangles;
};

void reconstruct(CgalInput& input, double cell) {
  input.used = input.cloud;
  input.used.erase(CGAL::grid_simplify_point_set(input.used, cell), input.used.end());
  input.triangles.clear();
  CGAL::advancing_front_surface_reconstruction(input.used.begin(), input.used.end(),
                                               std::back_inserter(input.triangles));
}

TriangleMesh mesh_from(const CgalInput& input) {
  TriangleMesh mesh;
  for (const auto& p : input.used)
    mesh.positions.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()),
                                static_cast<float>(p.z()));
  for (const auto& t : input.triangles)
    mesh.triangles.push_back({static_cast<std::uint32_t>(t[0]), static_cast<std::uint32_t>(t[1]),
                              static_cast<std::uint32_t>(t[2])});
  return mesh;
}

}  // namespace

std::vector<Peer> cgal_peers(std::span<const Eigen::Vector3f> points, double cell) {
  const auto input = std::make_shared<CgalInput>();
  for (const auto& p : points) input->cloud.emplace_back(p.x(), p.y(), p.z());
  return {{"CGAL grid_simplify, advancing front", [input, cell] { reconstruct(*input, cell); },
           [input] { return mesh_from(*input); }}};
}

}  // namespace linescope::bench
