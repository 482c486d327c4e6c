#include "viewer/surface/cubes_mesher.hpp"

#include <Eigen/Geometry>
#include <limits>
#include <utility>

#include "viewer/surface/point_tile.hpp"

namespace linescope {
namespace {

void normals_from_triangles(TriangleMesh& mesh) {
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3f& p = mesh.positions[a];
    const Eigen::Vector3f gradient = (mesh.positions[b] - p).cross(mesh.positions[c] - p);
    for (const std::uint32_t vertex : {a, b, c}) mesh.normals[vertex] += gradient;
  }
  for (Eigen::Vector3f& normal : mesh.normals) normal.normalize();
}

}  // namespace

CubesMesher::CubesMesher(const MesherOptions& options)
    : options_(options),
      sweeps_(options.sweep_pause),
      quantizer_(options),
      tile_(kMaxTile),
      grid_(options.method == MeshMethod::classical_cubes ? options.isovalue : 0.5, options.max_memory) {}

void CubesMesher::add_line(const SurfaceLine& line) {
  const PlacedLine placed = quantizer_.place(line, counters_);
  if (placed.usable() == 0) {
    ++counters_.lines_refused;
    return;
  }
  if (sweeps_.begins_with(line.time)) grid_.begin_sweep();
  const std::uint64_t before = counters_.points;
  for_each_tile(placed.points, placed.bounds, kToNearestVertex,
                [&](std::span<const PlacedBlock> part, const TileBox& box) {
                  count_points(part, kToNearestVertex, box, tile_.data());
                  for (int i = 0; i < box.volume(); ++i) {
                    const std::uint32_t found = std::exchange(tile_[static_cast<std::size_t>(i)], 0);
                    if (found == 0) continue;
                    const bool room = grid_.add(placed.corner + box.place(i), found);
                    (room ? counters_.points : counters_.no_room) += found;
                  }
                });
  ++(counters_.points > before ? counters_.lines : counters_.lines_refused);
}

bool CubesMesher::remove_last_sweep() {
  sweeps_.request();
  const std::int64_t removed = grid_.remove_last_sweep();
  if (removed < 0) return false;
  counters_.points_removed += static_cast<std::uint64_t>(removed);
  return true;
}

void CubesMesher::clear() {
  sweeps_ = SweepTracker(options_.sweep_pause);
  grid_.clear();
  cubes_.clear();
  counters_ = {};
}

void CubesMesher::write_mesh(TriangleMesh& mesh) {
  update();
  mesh.clear();
  place_vertices(mesh);
  connect_triangles(mesh);
  if (!classical()) normals_from_triangles(mesh);
  mesh.uncertainty.assign(mesh.vertex_count(), std::numeric_limits<float>::quiet_NaN());
  mesh.origin.assign(mesh.triangle_count(), TriangleOrigin::measured);
}

void CubesMesher::place_vertices(TriangleMesh& mesh) {
  first_vertex_.resize(grid_.table().size());
  for (const std::int32_t number : grid_.table().ordered()) {
    first_vertex_[static_cast<std::size_t>(number)] = static_cast<std::uint32_t>(mesh.positions.size());
    const CubeBlock& block = cubes_.block(number);
    if (block.vertices == 0) continue;
    for (int axis = 0; axis < 3; ++axis)
      for (int row = 0; row < 64; ++row)
        for (unsigned bits = block.crossed[static_cast<std::size_t>(axis)][static_cast<std::size_t>(row)];
             bits != 0; bits &= bits - 1)
          place_vertex(number, axis, row << 3 | std::countr_zero(bits), mesh);
  }
}

void CubesMesher::place_vertex(std::int32_t number, int axis, int local, TriangleMesh& mesh) const {
  const GridIndex low{local & 7, local >> 3 & 7, local >> 6};
  GridIndex high = low;
  (axis == 0 ? high.x : axis == 1 ? high.y : high.z) += 1;
  const std::uint32_t at_low = grid_.count_near(number, low.x, low.y, low.z);
  const std::uint32_t at_high = grid_.count_near(number, high.x, high.y, high.z);
  const GridIndex place = grid_of(grid_.table().coordinate(number), local);
  Eigen::Vector3d position(place.x, place.y, place.z);
  double fraction = 0.5;
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  if (classical()) {
    fraction = (options_.isovalue - at_low) / (static_cast<double>(at_high) - at_low);
    const auto f = static_cast<float>(fraction);
    normal = -((1 - f) * density_gradient(number, low) + f * density_gradient(number, high));
    if (normal.squaredNorm() < 1e-12f) normal[axis] = at_low > at_high ? 1.0f : -1.0f;
    normal.normalize();
  }
  position[axis] += fraction;
  mesh.positions.push_back((position * options_.interval).cast<float>());
  mesh.normals.push_back(normal);
  mesh.observations.push_back(std::max(at_low, at_high));
}

Eigen::Vector3f CubesMesher::density_gradient(std::int32_t block, GridIndex at) const {
  const auto density = [&](int dx, int dy, int dz) {
    return static_cast<float>(grid_.count_near(block, at.x + dx, at.y + dy, at.z + dz));
  };
  return {density(1, 0, 0) - density(-1, 0, 0), density(0, 1, 0) - density(0, -1, 0),
          density(0, 0, 1) - density(0, 0, -1)};
}

void CubesMesher::connect_triangles(TriangleMesh& mesh) {
  for (const std::int32_t number : grid_.table().ordered())
    for (const auto& [a, b, c] : cubes_.block(number).triangles)
      mesh.triangles.push_back(
          {vertex_number(number, a), vertex_number(number, b), vertex_number(number, c)});
}

std::uint32_t CubesMesher::vertex_number(std::int32_t number, EdgeCode edge) const {
  const int step = edge.block_step();
  const int slot = neighbour_slot(step & 1, step >> 1 & 1, step >> 2);
  const std::int32_t owner = grid_.table().neighbours(number)[static_cast<std::size_t>(slot)];
  return first_vertex_[static_cast<std::size_t>(owner)] + cubes_.block(owner).rank(edge.axis(), edge.local());
}

std::vector<Eigen::Vector3f> CubesMesher::grid_vertices() {
  std::vector<Eigen::Vector3f> result;
  result.reserve(grid_.marked());
  for (const std::int32_t number : grid_.table().ordered())
    for (int local = 0; local < kBlockCells; ++local) {
      if (grid_.block(number).count[static_cast<std::size_t>(local)] == 0) continue;
      const GridIndex at = grid_of(grid_.table().coordinate(number), local);
      result.push_back((Eigen::Vector3d(at.x, at.y, at.z) * options_.interval).cast<float>());
    }
  return result;
}

MesherState CubesMesher::state() {
  return {.occupied_cells = grid_.marked(),
          .set_aside = 0,
          .sweeps = grid_.sweeps(),
          .memory_bytes = grid_.memory_bytes()};
}

}  // namespace linescope
