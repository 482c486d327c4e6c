#include "tests/unit/surface/mesh_topology.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace linescope::testing {
namespace {

std::size_t root(std::vector<std::size_t>& parent, std::size_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

std::size_t count_pieces(const TriangleMesh& mesh) {
  std::vector<std::size_t> parent(mesh.vertex_count());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  for (const auto& t : mesh.triangles) {
    parent[root(parent, t[1])] = root(parent, t[0]);
    parent[root(parent, t[2])] = root(parent, t[0]);
  }
  std::vector<bool> used(mesh.vertex_count());
  std::size_t pieces = 0;
  for (const auto& t : mesh.triangles) {
    const std::size_t piece = root(parent, t[0]);
    if (!used[piece]) ++pieces;
    used[piece] = true;
  }
  return pieces;
}

using DirectedEdge = std::pair<std::uint32_t, std::uint32_t>;

std::vector<DirectedEdge> sorted_edges(const TriangleMesh& mesh) {
  std::vector<DirectedEdge> edges;
  edges.reserve(3 * mesh.triangle_count());
  for (const auto& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) edges.push_back({t[i], t[(i + 1) % 3]});
  std::sort(edges.begin(), edges.end());
  return edges;
}

}  // namespace

MeshTopology topology_of(const TriangleMesh& mesh) {
  MeshTopology result;
  std::vector<bool> used(mesh.vertex_count());
  for (const auto& t : mesh.triangles) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) ++result.degenerate;
    for (const std::uint32_t vertex : t) used[vertex] = true;
  }
  result.triangles = mesh.triangle_count();
  result.vertices = static_cast<std::size_t>(std::count(used.begin(), used.end(), true));
  const std::vector<DirectedEdge> edges = sorted_edges(mesh);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const DirectedEdge edge = edges[i];
    if (i > 0 && edges[i - 1] == edge) {
      ++result.repeated_edges;
      continue;
    }
    const bool has_opposite =
        std::binary_search(edges.begin(), edges.end(), DirectedEdge{edge.second, edge.first});
    if (!has_opposite) ++result.open_edges;
    if (edge.first < edge.second || !has_opposite) ++result.edges;
  }
  result.pieces = count_pieces(mesh);
  return result;
}

}  // namespace linescope::testing
