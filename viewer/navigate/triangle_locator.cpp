#include "viewer/navigate/triangle_locator.hpp"

#include <algorithm>
#include <array>
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

/// Squared distance from a place to cells around the one it lies in.
class TriangleLocator::Gaps {
 public:
  Gaps(const CellGrid& grid, const Eigen::Vector3f& place)
      : home_(grid.cell_of(place.cast<double>())),
        size_(static_cast<float>(grid.cell_size())),
        half_(size_ / 2),
        from_centre_((place.cast<double>() - grid.centre_of(home_)).cast<float>()) {}

  const CellIndex& home() const { return home_; }

  float squared(const CellIndex& cell) const {
    const CellIndex steps = cell - home_;
    return squared(0, steps.x()) + squared(1, steps.y()) + squared(2, steps.z());
  }
  /// Of cells that many steps along an axis: the part of this axis.
  float squared(int axis, int steps) const {
    const float gap =
        std::max(std::abs(from_centre_[axis] - size_ * static_cast<float>(steps)) - half_, 0.0f);
    return gap * gap;
  }
  /// Everything nearer than this lies in the box of that many rings around home.
  float certain(int rings) const {
    return half_ - from_centre_.cwiseAbs().maxCoeff() + static_cast<float>(rings) * size_;
  }

 private:
  CellIndex home_;
  float size_, half_;
  Eigen::Vector3f from_centre_;
};

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
  visit_cells_of(stored, [&](Cell& cell) {
    int lane = cell.empty() ? -1 : cell.back().lane_of(TriangleBatch::kNone);
    if (lane < 0) {
      cell.emplace_back();
      lane = 0;
    }
    cell.back().put(lane, stored.a, stored.ab, stored.ac, place);
  });
  mine.push_back(place);
  ++size_;
}

/// The last of the cell takes its place, so that only the last batch has free lanes.
void TriangleLocator::remove(std::int32_t triangle) {
  visit_cells_of(triangles_[static_cast<std::size_t>(triangle)], [&](Cell& cell) {
    const auto batch = std::find_if(cell.begin(), cell.end(),
                                    [&](const TriangleBatch& b) { return b.lane_of(triangle) >= 0; });
    if (batch == cell.end()) return;
    TriangleBatch& last = cell.back();
    const int free = last.lane_of(TriangleBatch::kNone), end = (free < 0 ? TriangleBatch::kLanes : free) - 1;
    const std::int32_t moved = last.triangle[static_cast<std::size_t>(end)];
    const Stored& t = triangles_[static_cast<std::size_t>(moved)];
    batch->put(batch->lane_of(triangle), t.a, t.ab, t.ac, moved);
    last.empty(end);
    if (end == 0) cell.pop_back();
  });
  free_.push_back(triangle);
  --size_;
}

void TriangleLocator::look_into(std::int32_t cell, const Eigen::Vector3f& place, Best& best) const {
  for (const TriangleBatch& batch : cells_[static_cast<std::size_t>(cell)]) {
    const int lane = nearer_lane(batch, place, best.squared);
    if (lane != TriangleBatch::kNoLane) best.triangle = batch.triangle[static_cast<std::size_t>(lane)];
  }
}

/// The cell of the place and its 26 neighbours, the nearest first: most are then too far to be looked into.
void TriangleLocator::look_next_door(const Gaps& gaps, const Eigen::Vector3f& place, Best& best) const {
  struct Door {
    float gap;
    std::int32_t cell;
  };
  std::array<Door, 27> doors;
  std::size_t count = 0;
  std::array<std::array<float, 3>, 3> along;  // axis by axis: before, at home, behind
  for (int axis = 0; axis < 3; ++axis)
    for (int step = -1; step <= 1; ++step)
      along[static_cast<std::size_t>(axis)][static_cast<std::size_t>(step + 1)] = gaps.squared(axis, step);
  const CellIndex low = gaps.home() - CellIndex::Ones();
  grid_.visit_box(low, gaps.home() + CellIndex::Ones(), [&](std::int32_t cell, const CellIndex& c) {
    const auto step = [&](int axis) { return static_cast<std::size_t>(c[axis] - low[axis]); };
    doors[count++] = {along[0][step(0)] + along[1][step(1)] + along[2][step(2)], cell};
  });
  while (count > 0) {
    std::size_t next = 0;
    for (std::size_t i = 1; i < count; ++i)
      if (doors[i].gap < doors[next].gap) next = i;
    if (doors[next].gap >= best.squared) return;
    look_into(doors[next].cell, place, best);
    doors[next] = doors[--count];
  }
}

/// The rings after `from` up to `to`.
void TriangleLocator::look_farther(const Gaps& gaps, int from, int to, const Eigen::Vector3f& place,
                                   Best& best) const {
  const CellIndex& home = gaps.home();
  const CellIndex r = CellIndex::Constant(to);
  grid_.visit_box(home - r, home + r, [&](std::int32_t cell, const CellIndex& c) {
    if ((c - home).cwiseAbs().maxCoeff() > from && gaps.squared(c) < best.squared)
      look_into(cell, place, best);
  });
}

std::optional<TriangleLocator::Nearest> TriangleLocator::nearest(const Eigen::Vector3f& place,
                                                                 float reach) const {
  if (size_ == 0 || !place.allFinite() || !grid_.holds(place.cast<double>())) return std::nullopt;
  Best best{reach * reach};
  const Gaps gaps(grid_, place);
  look_next_door(gaps, place, best);
  for (int ring = 1; gaps.certain(ring) < reach; ring *= 2) {
    if (best.squared <= gaps.certain(ring) * gaps.certain(ring)) break;
    look_farther(gaps, ring, 2 * ring, place, best);
  }
  if (best.triangle == TriangleBatch::kNone) return std::nullopt;
  const Stored& t = triangles_[static_cast<std::size_t>(best.triangle)];
  const Eigen::Vector3f point = nearest_on(t.a, t.ab, t.ac, place);
  return Nearest{t.owner, point, (point - place).norm()};
}

}  // namespace linescope
