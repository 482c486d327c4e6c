#include "viewer/surface/surface_extractor.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "viewer/surface/cube_table.hpp"

namespace linescope {
namespace {

constexpr std::uint32_t kUnused = 0xFFFFFFFF;

// Cuts nearer to a vertex than this share of the edge would leave slivers: the vertex counts as inside.
constexpr float kSupportTolerance = 0.02f;

template <class T>
T between(const T& a, const T& b, float fraction) {
  return a + fraction * (b - a);
}

}  // namespace

void SurfaceExtractor::extract(DistanceField& field, TriangleMesh& mesh) {
  mesh.clear();
  support_.clear();
  cuts_.clear();
  clipped_ = false;
  on_edge_.assign(field.vertex_count(), {-1, -1, -1});
  field.for_each_ordered([&](std::int32_t number) {
    if (field.vertex(number).corners != 0) add_cube(field, field.vertex(number), mesh);
  });
  if (clipped_) drop_unused_vertices(mesh);
  mesh.origin.assign(mesh.triangle_count(), TriangleOrigin::measured);
}

void SurfaceExtractor::add_cube(const DistanceField& field, const FieldVertex& low, TriangleMesh& mesh) {
  const CubeCase& found = cube_case(low.corners);
  const std::array<std::int32_t, 8> corners = field.corners_of(low);
  for (std::size_t t = 0; t < found.triangles; ++t) {
    Triangle triangle{};
    for (std::size_t i = 0; i < 3; ++i)
      triangle[i] = edge_vertex(field, corners, found.vertices[3 * t + i], mesh);
    add_clipped(triangle, mesh);
  }
}

std::uint32_t SurfaceExtractor::edge_vertex(const DistanceField& field,
                                            const std::array<std::int32_t, 8>& corners, int edge,
                                            TriangleMesh& mesh) {
  const EdgeCorners ends = edge_corners(edge);
  const std::int32_t low = corners[ends.low];
  std::int32_t& number = on_edge_[static_cast<std::size_t>(low)][static_cast<std::size_t>(edge_axis(edge))];
  if (number < 0) {
    number = static_cast<std::int32_t>(mesh.positions.size());
    add_between(field.vertex(low), field.vertex(corners[ends.high]), mesh);
  }
  return static_cast<std::uint32_t>(number);
}

void SurfaceExtractor::add_between(const FieldVertex& low, const FieldVertex& high, TriangleMesh& mesh) {
  const float f = low.distance / (low.distance - high.distance);
  const Eigen::Vector3d from(low.at.x, low.at.y, low.at.z), to(high.at.x, high.at.y, high.at.z);
  mesh.positions.push_back(((from + static_cast<double>(f) * (to - from)) * interval_).cast<float>());
  mesh.normals.push_back(between(low.normal, high.normal, f).normalized());
  mesh.uncertainty.push_back(between(low.deviation, high.deviation, f) * static_cast<float>(interval_));
  const auto points = between(static_cast<float>(low.sums.points), static_cast<float>(high.sums.points), f);
  mesh.observations.push_back(static_cast<std::uint32_t>(points + 0.5f));
  support_.push_back(between(low.support, high.support, f) + kSupportTolerance);
}

void SurfaceExtractor::add_clipped(const Triangle& triangle, TriangleMesh& mesh) {
  std::array<std::uint32_t, 4> kept{};
  std::size_t count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t a = triangle[i], b = triangle[(i + 1) % 3];
    const bool a_inside = support_[a] >= 0, b_inside = support_[b] >= 0;
    if (a_inside) kept[count++] = a;
    if (a_inside != b_inside) kept[count++] = cut_point(a, b, mesh);
  }
  clipped_ = clipped_ || count != 3 || support_[triangle[0]] < 0 || support_[triangle[1]] < 0 ||
             support_[triangle[2]] < 0;
  if (count >= 3) mesh.triangles.push_back({kept[0], kept[1], kept[2]});
  if (count == 4) mesh.triangles.push_back({kept[0], kept[2], kept[3]});
}

std::uint32_t SurfaceExtractor::cut_point(std::uint32_t a, std::uint32_t b, TriangleMesh& mesh) {
  if (a > b) std::swap(a, b);
  const auto [found, is_new] =
      cuts_.try_emplace(std::uint64_t{a} << 32 | b, static_cast<std::uint32_t>(mesh.positions.size()));
  if (!is_new) return found->second;
  const float f = support_[a] / (support_[a] - support_[b]);
  mesh.positions.push_back(between(mesh.positions[a], mesh.positions[b], f));
  mesh.normals.push_back(between(mesh.normals[a], mesh.normals[b], f).normalized());
  mesh.uncertainty.push_back(between(mesh.uncertainty[a], mesh.uncertainty[b], f));
  const auto points =
      between(static_cast<float>(mesh.observations[a]), static_cast<float>(mesh.observations[b]), f);
  mesh.observations.push_back(static_cast<std::uint32_t>(points + 0.5f));
  support_.push_back(0);
  return found->second;
}

void SurfaceExtractor::drop_unused_vertices(TriangleMesh& mesh) {
  new_number_.assign(mesh.vertex_count(), kUnused);
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) new_number_[v] = 0;
  std::uint32_t next = 0;
  for (std::size_t i = 0; i < new_number_.size(); ++i) {
    if (new_number_[i] == kUnused) continue;
    mesh.positions[next] = mesh.positions[i];
    mesh.normals[next] = mesh.normals[i];
    mesh.uncertainty[next] = mesh.uncertainty[i];
    mesh.observations[next] = mesh.observations[i];
    new_number_[i] = next++;
  }
  mesh.positions.resize(next);
  mesh.normals.resize(next);
  mesh.uncertainty.resize(next);
  mesh.observations.resize(next);
  for (Triangle& t : mesh.triangles)
    for (std::uint32_t& v : t) v = new_number_[v];
}

}  // namespace linescope
