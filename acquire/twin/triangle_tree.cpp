#include "acquire/twin/triangle_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace linescope::twin {
namespace {

using Eigen::Vector3d;

constexpr int kLeafSize = 4;
constexpr int kStackDepth = 64;

// Distance at which the ray enters the box, infinity when it misses it or only beyond `limit`.
double entry(const Eigen::AlignedBox3d& box, const Vector3d& origin, const Vector3d& inverse, double limit) {
  const Eigen::Array3d a = (box.min() - origin).array() * inverse.array();
  const Eigen::Array3d b = (box.max() - origin).array() * inverse.array();
  const double near = std::max(a.min(b).maxCoeff(), 0.0);
  const double far = std::min(a.max(b).minCoeff(), limit);
  return near <= far ? near : std::numeric_limits<double>::infinity();
}

// A component of exactly zero would give 0 * infinity on a box's face.
Vector3d safe_inverse(const Vector3d& direction) {
  return direction.unaryExpr([](double v) { return 1.0 / (std::abs(v) < 1e-300 ? 1e-300 : v); });
}

// Nearest point of the triangle (a, a + e1, a + e2) as weights of its corners.
Vector3d nearest_weights(const Vector3d& a, const Vector3d& e1, const Vector3d& e2, const Vector3d& point) {
  const Vector3d ap = point - a, bp = ap - e1, cp = ap - e2;
  const double d1 = e1.dot(ap), d2 = e2.dot(ap), d3 = e1.dot(bp), d4 = e2.dot(bp), d5 = e1.dot(cp),
               d6 = e2.dot(cp);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0, 1 - w, w};
  }
  const double sum = va + vb + vc;
  return {va / sum, vb / sum, vc / sum};
}

}  // namespace

TriangleTree::TriangleTree(TriangleSoup mesh) : mesh_(std::move(mesh)) {
  const int count = static_cast<int>(mesh_.triangles.size());
  order_.resize(mesh_.triangles.size());
  std::iota(order_.begin(), order_.end(), 0);
  std::vector<Vector3d> centres;
  for (int i = 0; i < count; ++i) centres.push_back((corner(i, 0) + corner(i, 1) + corner(i, 2)) / 3);
  nodes_.reserve(2 * mesh_.triangles.size());
  nodes_.emplace_back();
  split(0, 0, count, centres);
  for (const int i : order_)
    faces_.push_back({corner(i, 0), corner(i, 1) - corner(i, 0), corner(i, 2) - corner(i, 0)});
}

Vector3d TriangleTree::corner(int triangle, int which) const {
  const auto& indices = mesh_.triangles[static_cast<std::size_t>(triangle)];
  return mesh_.points[static_cast<std::size_t>(indices[static_cast<std::size_t>(which)])];
}

Vector3d TriangleTree::face_normal(int triangle) const {
  const Vector3d a = corner(triangle, 0);
  return (corner(triangle, 1) - a).cross(corner(triangle, 2) - a).normalized();
}

// Median split along the longest side of the centres' box: balanced, so the depth stays below kStackDepth.
void TriangleTree::split(int node, int first, int count, const std::vector<Vector3d>& centres) {
  Eigen::AlignedBox3d box, spread;
  const auto begin = order_.begin() + first, end = begin + count;
  for (auto it = begin; it != end; ++it) {
    for (int k = 0; k < 3; ++k) box.extend(corner(*it, k));
    spread.extend(centres[static_cast<std::size_t>(*it)]);
  }
  Node& here = nodes_[static_cast<std::size_t>(node)];
  here.box = box;
  here.first = first;
  here.count = count;
  if (count <= kLeafSize) return;
  Eigen::Index axis = 0;
  spread.sizes().maxCoeff(&axis);
  std::nth_element(begin, begin + count / 2, end, [&](int a, int b) {
    return centres[static_cast<std::size_t>(a)][axis] < centres[static_cast<std::size_t>(b)][axis];
  });
  const int children = static_cast<int>(nodes_.size());
  here.first = children;
  here.count = 0;
  nodes_.resize(nodes_.size() + 2);
  split(children, first, count / 2, centres);
  split(children + 1, first + count / 2, count - count / 2, centres);
}

void TriangleTree::search_leaf(const Node& node, const Vector3d& origin, const Vector3d& direction,
                               RayHit& best) const {
  for (int i = node.first; i < node.first + node.count; ++i) {
    const Face& face = faces_[static_cast<std::size_t>(i)];
    const Vector3d p = direction.cross(face.edge2);
    const double determinant = face.edge1.dot(p);
    if (std::abs(determinant) < 1e-300) continue;
    const Vector3d s = origin - face.origin;
    const double u = s.dot(p) / determinant;
    if (u < 0 || u > 1) continue;
    const Vector3d q = s.cross(face.edge1);
    const double v = direction.dot(q) / determinant;
    if (v < 0 || u + v > 1) continue;
    const double t = face.edge2.dot(q) / determinant;
    if (t > 1e-9 && t < best.distance) best = {t, order_[static_cast<std::size_t>(i)]};
  }
}

std::optional<TriangleTree::RayHit> TriangleTree::cast(const Vector3d& origin,
                                                       const Vector3d& direction) const {
  const Vector3d inverse = safe_inverse(direction);
  RayHit best{std::numeric_limits<double>::infinity(), -1};
  struct Waiting {
    int node;
    double entry;
  };
  std::array<Waiting, kStackDepth> stack;
  std::size_t depth = 0;
  stack[depth++] = {0, entry(nodes_[0].box, origin, inverse, best.distance)};
  while (depth > 0) {
    const Waiting next = stack[--depth];
    if (!(next.entry < best.distance)) continue;
    const Node& node = nodes_[static_cast<std::size_t>(next.node)];
    if (node.count > 0) {
      search_leaf(node, origin, direction, best);
      continue;
    }
    Waiting near{node.first, 0}, far{node.first + 1, 0};
    for (Waiting* child : {&near, &far}) {
      child->entry = entry(nodes_[static_cast<std::size_t>(child->node)].box, origin, inverse, best.distance);
    }
    if (far.entry < near.entry) std::swap(near, far);
    if (std::isfinite(far.entry)) stack[depth++] = far;
    if (std::isfinite(near.entry)) stack[depth++] = near;
  }
  if (best.triangle < 0) return std::nullopt;
  return best;
}

void TriangleTree::search_nearest(int index, const Vector3d& point, Foot& best) const {
  const Node& node = nodes_[static_cast<std::size_t>(index)];
  if (node.box.squaredExteriorDistance(point) >= best.squared_distance) return;
  for (int i = node.first; i < node.first + node.count; ++i) {
    const Face& face = faces_[static_cast<std::size_t>(i)];
    const Vector3d weights = nearest_weights(face.origin, face.edge1, face.edge2, point);
    const Vector3d foot = face.origin + weights.y() * face.edge1 + weights.z() * face.edge2;
    const double squared = (point - foot).squaredNorm();
    if (squared < best.squared_distance) best = {foot, squared, order_[static_cast<std::size_t>(i)], weights};
  }
  if (node.count > 0) return;
  int near = node.first, far = node.first + 1;
  const auto squared_to = [&](int child) {
    return nodes_[static_cast<std::size_t>(child)].box.squaredExteriorDistance(point);
  };
  if (squared_to(far) < squared_to(near)) std::swap(near, far);
  search_nearest(near, point, best);
  search_nearest(far, point, best);
}

TriangleTree::Foot TriangleTree::nearest(const Vector3d& point) const {
  Foot best{Vector3d::Zero(), std::numeric_limits<double>::infinity(), -1, Vector3d::Zero()};
  search_nearest(0, point, best);
  return best;
}

}  // namespace linescope::twin
