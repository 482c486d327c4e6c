#include "acquire/twin/triangle_phantom.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace linescope::twin {
namespace {

using Eigen::Vector3d;

std::uint64_t edge_key(int from, int to) {
  return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(from)) << 32) |
         static_cast<std::uint32_t>(to);
}

// Edges that are not met by exactly one edge of the other direction. A closed, consistently wound surface has
// none.
std::size_t open_edges(const TriangleSoup& mesh) {
  std::unordered_map<std::uint64_t, int> balance;
  for (const auto& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const int from = t[k], to = t[(k + 1) % 3];
      balance[edge_key(std::min(from, to), std::max(from, to))] += from < to ? 1 : -1;
    }
  }
  return static_cast<std::size_t>(
      std::count_if(balance.begin(), balance.end(), [](const auto& edge) { return edge.second != 0; }));
}

double signed_volume(const TriangleSoup& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const auto point = [&](std::size_t k) -> const Vector3d& {
      return mesh.points[static_cast<std::size_t>(t[k])];
    };
    sum += point(0).dot(point(1).cross(point(2)));
  }
  return sum / 6;
}

Result<void> check_numbers(const TriangleSoup& mesh) {
  if (mesh.triangles.empty() || mesh.points.empty()) {
    return fail(ErrorCode::invalid, "the mesh is empty: it has no triangle to look at");
  }
  const int count = static_cast<int>(mesh.points.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles[i];
    if (std::all_of(t.begin(), t.end(), [count](int k) { return k >= 0 && k < count; })) continue;
    return fail(ErrorCode::invalid,
                fmt::format("triangle {} of the mesh names a point that is not there", i));
  }
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    if (mesh.points[i].allFinite()) continue;
    return fail(ErrorCode::invalid, fmt::format("point {} of the mesh is not a finite number", i));
  }
  return {};
}

Result<void> check_size(const TriangleSoup& mesh) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : mesh.points) box.extend(p);
  const Vector3d size = box.sizes();
  const std::string text = fmt::format("{:.4g} x {:.4g} x {:.4g}", size.x(), size.y(), size.z());
  if (size.maxCoeff() < 1.0) {
    return fail(
        ErrorCode::invalid,
        fmt::format("the mesh measures {}, which looks like metres: scale it by 1000 to millimetres", text));
  }
  if (size.maxCoeff() > 2000) {
    return fail(
        ErrorCode::invalid,
        fmt::format("the mesh measures {}, which is too large for millimetres: scale it down (micrometres?)",
                    text));
  }
  return {};
}

Vector3d highest_point(const TriangleSoup& mesh) {
  return *std::max_element(mesh.points.begin(), mesh.points.end(),
                           [](const Vector3d& a, const Vector3d& b) { return a.z() < b.z(); });
}

}  // namespace

Result<void> validate(const TriangleSoup& mesh) {
  if (auto numbers = check_numbers(mesh); !numbers) return numbers;
  if (auto size = check_size(mesh); !size) return size;
  if (const std::size_t open = open_edges(mesh); open > 0) {
    return fail(
        ErrorCode::invalid,
        fmt::format("the mesh is not closed: {} edges have no partner triangle; close its holes first",
                    open));
  }
  if (!(std::abs(signed_volume(mesh)) > 0)) return fail(ErrorCode::invalid, "the mesh encloses no volume");
  return {};
}

Result<std::shared_ptr<const Phantom>> make_triangle_phantom(const TriangleSoup& mesh) {
  if (auto valid = validate(mesh); !valid) return tl::unexpected(valid.error());
  TriangleSoup own = mesh;
  if (signed_volume(own) < 0) {
    for (auto& t : own.triangles) std::swap(t[1], t[2]);
  }
  const Vector3d top = highest_point(own);
  for (Vector3d& p : own.points) p -= top;
  return std::make_shared<TrianglePhantom>(std::move(own));
}

TrianglePhantom::TrianglePhantom(TriangleSoup mesh) : tree_(std::move(mesh)) {}

bool TrianglePhantom::cast(const Vector3d& origin, const Vector3d& direction, Hit& hit) const {
  const auto found = tree_.cast(origin, direction);
  if (!found) return false;
  hit.distance = found->distance;
  hit.normal = tree_.face_normal(found->triangle);
  return true;
}

Vector3d TrianglePhantom::normal(const Vector3d& point) const {
  return tree_.face_normal(tree_.nearest(point).triangle);
}

// Inside or outside by an odd or even number of surfaces on the way out: holds for every closed mesh, also
// where the nearest point is an edge and the two faces disagree.
double TrianglePhantom::distance(const Vector3d& point) const {
  const double length = std::sqrt(tree_.nearest(point).squared_distance);
  const Vector3d way = Vector3d(0.1234, 0.3456, 0.9301).normalized();
  Vector3d from = point;
  bool inside = false;
  while (const auto hit = tree_.cast(from, way)) {
    inside = !inside;
    from += (hit->distance + 1e-7) * way;
  }
  return inside ? -length : length;
}

std::string TrianglePhantom::json() const {
  return fmt::format(R"({{"kind":"mesh","points":{},"triangles":{}}})", tree_.mesh().points.size(),
                     tree_.mesh().triangles.size());
}

}  // namespace linescope::twin
