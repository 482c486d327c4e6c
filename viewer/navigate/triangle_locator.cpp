#include "viewer/navigate/triangle_locator.hpp"

#include <algorithm>
#include <cmath>

namespace linescope {
namespace {

/// Nearest point of the triangle a + u ab + v ac to p, by the region of the plane p lies over.
Eigen::Vector3f nearest_on(const Eigen::Vector3f& a, const Eigen::Vector3f& ab, const Eigen::Vector3f& ac,
                           const Eigen::Vector3f& p) {
  const Eigen::Vector3f ap = p - a;
  const float d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const float bb = ab.squaredNorm(), cc = ac.squaredNorm(), bc = ab.dot(ac);
  const float d3 = d1 - bb, d4 = d2 - bc;  // the same products seen from b
  if (d3 >= 0 && d4 <= d3) return a + ab;
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  const float d5 = d1 - bc, d6 = d2 - cc;  // from c
  if (d6 >= 0 && d5 <= d6) return a + ac;
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return a + ab + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (ac - ab);
  const float whole = 1 / (va + vb + vc);
  return a + vb * whole * ab + vc * whole * ac;
}

}  // namespace

void TriangleLocator::assign(const TriangleMesh& mesh) {
  clear();
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles[i];
    const Triangle triangle{mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
    replace(i, std::span(&triangle, 1));
  }
}

void TriangleLocator::replace(std::uint64_t owner, std::span<const Triangle> triangles) {
  std::vector<std::int32_t>& mine = owners_[owner];
  for (const std::int32_t triangle : mine) remove(triangle);
  mine.clear();
  for (const Triangle& triangle : triangles) enter(triangle, owner, mine);
  if (mine.empty()) owners_.erase(owner);
}

void TriangleLocator::clear() {
  grid_.clear();
  cells_.clear();
  triangles_.clear();
  free_.clear();
  owners_.clear();
  size_ = 0;
}

template <class Visit>
void TriangleLocator::visit_cells_of(const Stored& t, Visit&& visit) {
  const Eigen::Vector3d a = t.a.cast<double>(), b = (t.a + t.ab).cast<double>(),
                        c = (t.a + t.ac).cast<double>();
  const CellIndex low = grid_.cell_of(a.cwiseMin(b).cwiseMin(c)),
                  high = grid_.cell_of(a.cwiseMax(b).cwiseMax(c));
  for (int z = low.z(); z <= high.z(); ++z)
    for (int y = low.y(); y <= high.y(); ++y)
      for (int x = low.x(); x <= high.x(); ++x) {
        const auto cell = static_cast<std::size_t>(grid_.find_or_make({x, y, z}));
        if (cell >= cells_.size()) cells_.resize(cell + 1);
        visit(cells_[cell]);
      }
}

void TriangleLocator::enter(const Triangle& t, std::uint64_t owner, std::vector<std::int32_t>& mine) {
  const Eigen::Vector3f centre = (t.a + t.b + t.c) / 3;
  if (!centre.allFinite() || !grid_.holds(centre.cast<double>())) return;
  const float radius = std::sqrt(
      std::max({(t.a - centre).squaredNorm(), (t.b - centre).squaredNorm(), (t.c - centre).squaredNorm()}));
  std::int32_t place;
  if (free_.empty()) {
    place = static_cast<std::int32_t>(triangles_.size());
    triangles_.emplace_back();
  } else {
    place = free_.back();
    free_.pop_back();
  }
  Stored& stored = triangles_[static_cast<std::size_t>(place)];
  stored = {t.a, t.b - t.a, t.c - t.a, owner};
  visit_cells_of(stored, [&](std::vector<Entry>& cell) { cell.push_back({centre, radius, place}); });
  mine.push_back(place);
  ++size_;
}

void TriangleLocator::remove(std::int32_t triangle) {
  visit_cells_of(triangles_[static_cast<std::size_t>(triangle)], [&](std::vector<Entry>& cell) {
    std::erase_if(cell, [&](const Entry& entry) { return entry.triangle == triangle; });
  });
  free_.push_back(triangle);
  --size_;
}

float TriangleLocator::distance_to_cell(const CellIndex& c, const Eigen::Vector3f& place) const {
  const auto half = static_cast<float>(grid_.cell_size() / 2);
  const Eigen::Vector3f from_centre = (place - grid_.centre_of(c).cast<float>()).cwiseAbs();
  return (from_centre.array() - half).max(0.0f).matrix().norm();
}

void TriangleLocator::look_into(std::int32_t cell, const Eigen::Vector3f& place, Best& best) const {
  for (const Entry& entry : cells_[static_cast<std::size_t>(cell)]) {
    // A triangle whose ball is farther than the best so far cannot win.
    const float beyond = best.distance + entry.radius;
    if ((entry.centre - place).squaredNorm() >= beyond * beyond || entry.triangle == best.triangle) continue;
    const Stored& t = triangles_[static_cast<std::size_t>(entry.triangle)];
    const Eigen::Vector3f point = nearest_on(t.a, t.ab, t.ac, place);
    const float squared = (point - place).squaredNorm();
    if (squared < best.distance * best.distance) best = {std::sqrt(squared), entry.triangle, point};
  }
}

std::optional<TriangleLocator::Nearest> TriangleLocator::nearest(const Eigen::Vector3f& place,
                                                                 float reach) const {
  if (size_ == 0 || !place.allFinite() || !grid_.holds(place.cast<double>())) return std::nullopt;
  Best best{reach};
  const CellIndex home = grid_.cell_of(place.cast<double>());
  // Everything nearer than the wall of the box looked at has been seen.
  const Eigen::Vector3d from_centre = (place.cast<double>() - grid_.centre_of(home)).cwiseAbs();
  const double to_wall = grid_.cell_size() / 2 - from_centre.maxCoeff();
  int seen = -1;
  for (int ring = 0;; ring = ring == 0 ? 1 : 2 * ring) {
    const CellIndex r = CellIndex::Constant(ring);
    grid_.visit_box(home - r, home + r, [&](std::int32_t cell, const CellIndex& c) {
      if ((c - home).cwiseAbs().maxCoeff() <= seen || distance_to_cell(c, place) >= best.distance) return;
      look_into(cell, place, best);
    });
    seen = ring;
    const double certain = to_wall + ring * grid_.cell_size();
    if (static_cast<double>(best.distance) <= certain || certain > static_cast<double>(reach)) break;
  }
  if (best.triangle < 0) return std::nullopt;
  return Nearest{triangles_[static_cast<std::size_t>(best.triangle)].owner, best.point, best.distance};
}

}  // namespace linescope
