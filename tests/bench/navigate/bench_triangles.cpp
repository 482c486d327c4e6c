// The triangle nearest to the tip (T14): our locator beside CGAL's AABB tree on the mesh of the viewer.
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>
#include <benchmark/benchmark.h>

#include "tests/bench/navigate/bench_world.hpp"
#include "viewer/navigate/triangle_locator.hpp"
#include "viewer/surface/mesher.hpp"

namespace linescope::bench {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Tree = CGAL::AABB_tree<
    CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>>>;

TriangleMesh mesh_of(const World& w) {
  const auto mesher = std::move(*make_mesher({}));
  for (const ScannedLine& line : w.scan)
    mesher->add_line({.points = line.points, .seen_from = {0, 0, 15}, .time = line.time, .id = line.id});
  return mesher->mesh();
}

Triangles triangles_of(const TriangleMesh& mesh) {
  const auto point = [&](std::uint32_t i) {
    const Eigen::Vector3f& p = mesh.positions[i];
    return Kernel::Point_3(p.x(), p.y(), p.z());
  };
  Triangles triangles;
  for (const auto& t : mesh.triangles) triangles.emplace_back(point(t[0]), point(t[1]), point(t[2]));
  return triangles;
}

void closest_triangle(benchmark::State& state) {
  const World w(state.range(0) == 1, {.point = 0.26, .drift = 0});
  const TriangleMesh mesh = mesh_of(w);
  TriangleLocator locator;
  locator.assign(mesh);
  const Triangles triangles = triangles_of(mesh);
  Tree tree(triangles.begin(), triangles.end());
  tree.accelerate_distance_queries();
  std::vector<double> ours, cgal;
  double excess = 0;
  for (auto _ : state)
    for (const PlacedSpot& spot : w.spots) {
      const Eigen::Vector3d& tip = spot.query.tip;
      const double a = microseconds();
      const auto found = locator.nearest(tip.cast<float>());
      const double b = microseconds();
      const double squared = tree.squared_distance(Kernel::Point_3(tip.x(), tip.y(), tip.z()));
      const double c = microseconds();
      ours.push_back(b - a);
      cgal.push_back(c - b);
      if (found) excess = std::max(excess, static_cast<double>(found->distance) - std::sqrt(squared));
    }
  state.counters["triangles"] = static_cast<double>(triangles.size());
  state.counters["ours_us"] = percentile(ours, 0.5);
  state.counters["cgal_us"] = percentile(cgal, 0.5);
  state.counters["T14_faster"] = percentile(cgal, 0.5) / percentile(ours, 0.5);
  state.counters["largest_excess_mm"] = excess;
}
BENCHMARK(closest_triangle)->Arg(0)->Arg(1)->Iterations(2)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace linescope::bench
