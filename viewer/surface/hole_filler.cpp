#include "viewer/surface/hole_filler.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "viewer/surface/rim_lid.hpp"
#include "viewer/surface/small_solver.hpp"

namespace linescope {
namespace {

using Vertex = std::uint32_t;
using Rim = std::vector<Vertex>;  // in the direction in which the triangles around it have the edges

using OpenEdges = std::unordered_multimap<Vertex, Vertex>;  // by their beginning

/// Directed edges of triangles without a triangle on the other side.
OpenEdges open_edges_of(const TriangleMesh& mesh) {
  const auto key = [](Vertex from, Vertex to) { return std::uint64_t{from} << 32 | to; };
  std::unordered_set<std::uint64_t> all;
  all.reserve(3 * mesh.triangle_count());
  for (const auto& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) all.insert(key(t[i], t[(i + 1) % 3]));
  OpenEdges open;
  for (const auto& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const Vertex from = t[i], to = t[(i + 1) % 3];
      if (!all.contains(key(to, from))) open.emplace(from, to);
    }
  return open;
}

/// How far to turn at a vertex from one neighbour to another, counter-clockwise seen from outside: more than
/// 0, up to a whole turn.
double turn(const TriangleMesh& mesh, Vertex at, Vertex from, Vertex to) {
  const Eigen::Vector3f a = mesh.positions[from] - mesh.positions[at],
                        b = mesh.positions[to] - mesh.positions[at];
  const Eigen::Vector3f n = mesh.normals[at];
  const float angle = std::atan2(a.cross(b).dot(n), a.dot(b) - a.dot(n) * b.dot(n));
  return angle > 0 ? angle : angle + 2 * std::numbers::pi;
}

/// Takes the edge that goes on from the edge `from` - `at`. Where holes touch in a vertex there are several:
/// the first one across the hole belongs to it. The open side lies to the right, so that is the smallest
/// turn.
Vertex take_next(const TriangleMesh& mesh, OpenEdges& open, Vertex from, Vertex at) {
  const auto [begin, end] = open.equal_range(at);
  const auto next = std::min_element(begin, end, [&](const auto& a, const auto& b) {
    return turn(mesh, at, from, a.second) < turn(mesh, at, from, b.second);
  });
  const Vertex to = next->second;
  open.erase(next);
  return to;
}

std::vector<Rim> rims_of(const TriangleMesh& mesh) {
  OpenEdges open = open_edges_of(mesh);
  std::vector<Rim> rims;
  for (const auto& t : mesh.triangles)
    for (const Vertex start : t)
      while (open.contains(start)) {
        Rim rim{start};
        Vertex from = start, at = open.find(start)->second;
        open.erase(open.find(start));
        while (at != start && open.contains(at)) {
          rim.push_back(at);
          const Vertex next = take_next(mesh, open, from, at);
          from = std::exchange(at, next);
        }
        if (at == start) rims.push_back(std::move(rim));
      }
  return rims;
}

double length_of(const TriangleMesh& mesh, const Rim& rim) {
  double length = 0;
  for (std::size_t i = 0; i < rim.size(); ++i)
    length += (mesh.positions[rim[(i + 1) % rim.size()]] - mesh.positions[rim[i]]).norm();
  return length;
}

/// Number of the connected piece of every vertex.
std::vector<Vertex> pieces_of(const TriangleMesh& mesh) {
  std::vector<Vertex> parent(mesh.vertex_count());
  std::iota(parent.begin(), parent.end(), Vertex{0});
  const auto root = [&](Vertex v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const auto& t : mesh.triangles) {
    parent[root(t[1])] = root(t[0]);
    parent[root(t[2])] = root(t[0]);
  }
  for (Vertex v = 0; v < parent.size(); ++v) parent[v] = root(v);
  return parent;
}

/// All borders but the longest of every piece.
std::vector<Rim> holes_of(const TriangleMesh& mesh) {
  std::vector<Rim> rims = rims_of(mesh);
  const std::vector<Vertex> piece = pieces_of(mesh);
  std::unordered_map<Vertex, double> longest;
  for (const Rim& rim : rims) {
    double& known = longest[piece[rim.front()]];
    known = std::max(known, length_of(mesh, rim));
  }
  std::erase_if(rims, [&](const Rim& r) { return length_of(mesh, r) >= longest[piece[r.front()]]; });
  return rims;
}

/// The rim as heights over the plane through its middle.
struct RimPlane {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  Eigen::Matrix3d plane_from_mesh;   // rows: u, v, up
  std::vector<Eigen::Vector3d> rim;  // u, v, height of its vertices
  std::array<double, 6> quadric{};   // height = a + b u + c v + d u^2 + e uv + f v^2
  double radius = 0;

  double height(double u, double v) const {
    const auto& q = quadric;
    return q[0] + q[1] * u + q[2] * v + q[3] * u * u + q[4] * u * v + q[5] * v * v;
  }
  Eigen::Vector3d normal(double u, double v) const {
    const auto& q = quadric;
    return Eigen::Vector3d(-q[1] - 2 * q[3] * u - q[4] * v, -q[2] - q[4] * u - 2 * q[5] * v, 1).normalized();
  }
};

void fit_quadric(const TriangleMesh& mesh, const Rim& rim, RimPlane& plane) {
  SmallSystem<6> system;
  const double slope_weight = plane.radius * plane.radius;  // a slope says as much as a height at the radius
  for (std::size_t i = 0; i < rim.size(); ++i) {
    const double u = plane.rim[i].x(), v = plane.rim[i].y();
    const double at[6] = {1, u, v, u * u, u * v, v * v}, along_u[6] = {0, 1, 0, 2 * u, v, 0},
                 along_v[6] = {0, 0, 1, 0, u, 2 * v};
    system.add(at, plane.rim[i].z(), 1);
    const Eigen::Vector3d n = plane.plane_from_mesh * mesh.normals[rim[i]].cast<double>();
    if (n.z() < 0.3) continue;
    system.add(along_u, -n.x() / n.z(), slope_weight);
    system.add(along_v, -n.y() / n.z(), slope_weight);
  }
  const double scale = 1e-9 * static_cast<double>(rim.size());
  const double bend = scale * slope_weight * slope_weight, slope = scale * slope_weight;
  const double means[6] = {}, weights[6] = {scale, slope, slope, bend, bend, bend};
  system.add_prior(means, weights);
  system.factorise();
  plane.quadric = system.solve();
}

RimPlane plane_of(const TriangleMesh& mesh, const Rim& rim) {
  RimPlane plane;
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  for (const Vertex v : rim) {
    plane.middle += mesh.positions[v].cast<double>() / static_cast<double>(rim.size());
    up += mesh.normals[v].cast<double>();
  }
  up.normalize();
  const Eigen::Vector3d u = up.unitOrthogonal();
  plane.plane_from_mesh << u.transpose(), up.cross(u).transpose(), up.transpose();
  for (const Vertex v : rim) {
    plane.rim.emplace_back(plane.plane_from_mesh * (mesh.positions[v].cast<double>() - plane.middle));
    plane.radius += plane.rim.back().head<2>().norm() / static_cast<double>(rim.size());
  }
  fit_quadric(mesh, rim, plane);
  return plane;
}

/// True when every edge of the rim is seen from the middle, from the right side: no triangle will fold.
bool star_shaped(const RimPlane& plane) {
  for (std::size_t i = 0; i < plane.rim.size(); ++i) {
    const auto &a = plane.rim[i], &b = plane.rim[(i + 1) % plane.rim.size()];
    if (b.x() * a.y() - b.y() * a.x() <= 1e-6 * plane.radius * plane.radius) return false;
  }
  return true;
}

Vertex add_vertex(TriangleMesh& mesh, const RimPlane& plane, const Eigen::Vector3d& at) {
  const Eigen::Matrix3d mesh_from_plane = plane.plane_from_mesh.transpose();
  mesh.positions.push_back((plane.middle + mesh_from_plane * at).cast<float>());
  mesh.normals.push_back((mesh_from_plane * plane.normal(at.x(), at.y())).cast<float>());
  mesh.uncertainty.push_back(std::numeric_limits<float>::quiet_NaN());
  mesh.observations.push_back(0);
  return static_cast<Vertex>(mesh.vertex_count() - 1);
}

/// Between the rim (share 1) and the middle (share 0).
Eigen::Vector3d towards_rim(const RimPlane& plane, std::size_t i, double share) {
  const Eigen::Vector3d& end = plane.rim[i];
  const double misfit = end.z() - plane.height(end.x(), end.y());
  const double u = share * end.x(), v = share * end.y();
  return {u, v, plane.height(u, v) + share * share * misfit};
}

Rim add_ring(TriangleMesh& mesh, const RimPlane& plane, const Rim& outer, double share) {
  Rim inner;
  for (std::size_t i = 0; i < outer.size(); ++i)
    inner.push_back(add_vertex(mesh, plane, towards_rim(plane, i, share)));
  for (std::size_t i = 0; i < outer.size(); ++i) {
    const std::size_t next = (i + 1) % outer.size();
    mesh.triangles.push_back({outer[next], outer[i], inner[i]});
    mesh.triangles.push_back({outer[next], inner[i], inner[next]});
  }
  return inner;
}

void fill(TriangleMesh& mesh, const RimPlane& plane, Rim ring, double edge) {
  const int rings = std::clamp(static_cast<int>(std::lround(plane.radius / edge)), 1, 64);
  for (int k = rings - 1; k > 0; --k) ring = add_ring(mesh, plane, ring, static_cast<double>(k) / rings);
  const Vertex middle = add_vertex(mesh, plane, {0, 0, plane.height(0, 0)});
  for (std::size_t i = 0; i < ring.size(); ++i)
    mesh.triangles.push_back({ring[(i + 1) % ring.size()], ring[i], middle});
  mesh.origin.resize(mesh.triangle_count(), TriangleOrigin::filled);
}

/// Whether two of the rim's vertices are joined by an edge, by their places in the rim.
std::vector<bool> joined_in(const TriangleMesh& mesh, const Rim& rim) {
  std::unordered_multimap<Vertex, std::size_t> places;
  for (std::size_t i = 0; i < rim.size(); ++i) places.emplace(rim[i], i);
  std::vector<bool> joined(rim.size() * rim.size());
  const auto mark = [&](Vertex a, Vertex b) {
    const auto [first, last] = places.equal_range(a);
    const auto [other_first, other_last] = places.equal_range(b);
    for (auto i = first; i != last; ++i)
      for (auto j = other_first; j != other_last; ++j)
        joined[i->second * rim.size() + j->second] = joined[j->second * rim.size() + i->second] = true;
  };
  for (const auto& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) mark(t[i], t[(i + 1) % 3]);
  return joined;
}

/// Over a rim that is not star-shaped. Its corners carry their misfit to the quadric as height, so that the
/// new ones in between meet the rim.
bool fill_any_shape(TriangleMesh& mesh, const RimPlane& plane, const Rim& rim, double edge) {
  const std::size_t n = rim.size();
  const std::vector<bool> joined = joined_in(mesh, rim);
  const std::vector<Eigen::Vector3d> corners(plane.rim.rbegin(), plane.rim.rend());
  auto lid = triangulate_rim(
      corners, [&](std::size_t i, std::size_t j) { return joined[(n - 1 - i) * n + (n - 1 - j)]; });
  if (!lid) return false;
  for (Eigen::Vector3d& c : lid->corners) c.z() -= plane.height(c.x(), c.y());
  split_long_edges(*lid, 1.5 * edge, 16 * kMaxRimCorners);
  std::vector<Vertex> vertices(rim.rbegin(), rim.rend());
  for (std::size_t i = n; i < lid->corners.size(); ++i) {
    const Eigen::Vector3d& c = lid->corners[i];
    vertices.push_back(add_vertex(mesh, plane, {c.x(), c.y(), plane.height(c.x(), c.y()) + c.z()}));
  }
  for (const auto& [a, b, c] : lid->triangles)
    mesh.triangles.push_back({vertices[a], vertices[b], vertices[c]});
  mesh.origin.resize(mesh.triangle_count(), TriangleOrigin::filled);
  return true;
}

/// The counter of what became of a hole.
std::size_t& close(TriangleMesh& mesh, const Rim& rim, double longest_rim, HoleCounts& counts) {
  const double length = length_of(mesh, rim), edge = length / static_cast<double>(rim.size());
  if (length > longest_rim) return counts.too_long;
  const RimPlane plane = plane_of(mesh, rim);
  if (star_shaped(plane)) {
    fill(mesh, plane, rim, edge);
    return counts.filled;
  }
  if (rim.size() > kMaxRimCorners) return counts.too_many;
  return fill_any_shape(mesh, plane, rim, edge) ? counts.filled : counts.crossing;
}

}  // namespace

std::string in_words(const HoleCounts& holes) {
  std::string reasons;
  const auto add = [&reasons](std::size_t count, const char* why) {
    if (count > 0) reasons += (reasons.empty() ? ": " : ", ") + std::to_string(count) + ' ' + why;
  };
  add(holes.too_long, "with too long a rim");
  add(holes.too_many, "with too many corners");
  add(holes.crossing, "whose rim crosses itself");
  const char* const closed = holes.filled == 1 ? " hole closed, " : " holes closed, ";
  return std::to_string(holes.filled) + closed + std::to_string(holes.left) + " open" + reasons;
}

HoleCounts fill_holes(TriangleMesh& mesh, double longest_rim) {
  HoleCounts counts;
  for (const Rim& rim : holes_of(mesh)) ++close(mesh, rim, longest_rim, counts);
  counts.left = counts.too_long + counts.too_many + counts.crossing;
  return counts;
}

}  // namespace linescope
