#include "twin_shapes.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <map>

namespace linescope::twin {
namespace {

using Eigen::Vector3d;

// Points of neighbouring sides coincide: one index each, so that the mesh is closed.
class PointBook {
 public:
  explicit PointBook(TriangleSoup& soup, double radius) : soup_(soup), radius_(radius) {}

  int index(const Eigen::Vector3i& cell, int divisions) {
    const auto key = std::array{cell.x(), cell.y(), cell.z()};
    const auto [it, fresh] = known_.try_emplace(key, static_cast<int>(soup_.points.size()));
    if (fresh)
      soup_.points.push_back(radius_ *
                             (2.0 * cell.cast<double>() / divisions - Vector3d::Ones()).normalized());
    return it->second;
  }

 private:
  TriangleSoup& soup_;
  double radius_;
  std::map<std::array<int, 3>, int> known_;
};

}  // namespace

TriangleSoup sphere_of_triangles(double radius, int levels) {
  TriangleSoup soup;
  PointBook book(soup, radius);
  const int n = 1 << levels;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {0, n}) {
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          const auto corner = [&](int di, int dj) {
            Eigen::Vector3i cell;
            cell[axis] = side;
            cell[(axis + 1) % 3] = i + di;
            cell[(axis + 2) % 3] = j + dj;
            return book.index(cell, n);
          };
          const int a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
          if (side == n) {
            soup.triangles.push_back({a, b, c});
            soup.triangles.push_back({a, c, d});
          } else {
            soup.triangles.push_back({a, c, b});
            soup.triangles.push_back({a, d, c});
          }
        }
      }
    }
  }
  return soup;
}

double nearest_hit_by_search(const TriangleSoup& soup, const Vector3d& from, const Vector3d& way) {
  double best = -1;
  for (const auto& t : soup.triangles) {
    const auto point = [&](std::size_t k) -> const Vector3d& {
      return soup.points[static_cast<std::size_t>(t[k])];
    };
    Eigen::Matrix3d system;
    system << point(1) - point(0), point(2) - point(0), -way;
    const Vector3d solution = system.fullPivLu().solve(from - point(0));
    const double u = solution.x(), v = solution.y(), distance = solution.z();
    if (u < 0 || v < 0 || u + v > 1 || distance <= 0) continue;
    if (best < 0 || distance < best) best = distance;
  }
  return best;
}

}  // namespace linescope::twin
