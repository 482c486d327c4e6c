// Signed distances at grid vertices, blended from the patches around them, and the cubes the surface runs
// through.
//
// All sums are integers: taking a patch out subtracts exactly what it added, so any history with the same
// patches ends in the same field.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include "viewer/surface/block_table.hpp"
#include "viewer/surface/chunked_pool.hpp"
#include "viewer/surface/patch_map.hpp"

namespace linescope {

/// What the patches say about a grid vertex, in fixed point (see distance_field.cpp for the units).
struct VertexSums {
  std::int64_t weight = 0;
  std::int64_t distance = 0;
  std::array<std::int64_t, 3> normal{};
  std::array<std::int64_t, 3> centre{};  ///< of the points in the columns around, from the vertex
  std::int64_t deviation = 0;
  std::int64_t points = 0;
};

/// The same as values.
struct FieldVertex {
  VertexSums sums;
  GridIndex at;
  std::int32_t block = BlockTable::kNone;
  float distance = 0;   ///< intervals, positive on the side it was seen from
  float support = 0;    ///< intervals to the border of what was seen, to first order; negative beyond
  float deviation = 0;  ///< intervals
  Eigen::Vector3f normal{0, 0, 0};
  std::uint8_t corners = 0;  ///< case of the cube above this vertex (0: no surface there)
  bool known = false;        ///< patches reach it and agree on the side
  bool changed = false;
};

class DistanceField final : public PatchListener {
 public:
  void patch_added(const MomentCell& cell, const SurfacePatch& patch) override { apply(cell, patch, 1); }
  void patch_removed(const MomentCell& cell, const SurfacePatch& patch) override { apply(cell, patch, -1); }

  /// Brings the values and cases up to date with the patches.
  void update();

  void clear();

  BlockTable& table() { return table_; }
  const FieldVertex& vertex(std::int32_t number) const { return vertices_[number]; }
  std::size_t vertex_count() const { return vertices_.size(); }

  /// The vertex at x, y, z (-8 to 15) from the lowest corner of a block: its number or kNone.
  std::int32_t vertex_near(std::int32_t block, int x, int y, int z) const {
    const int slot = neighbour_slot(x >> kBlockBits, y >> kBlockBits, z >> kBlockBits);
    const std::int32_t at = table_.neighbours(block)[static_cast<std::size_t>(slot)];
    return at == BlockTable::kNone
               ? at
               : blocks_[static_cast<std::size_t>(at)][static_cast<std::size_t>(local_of({x, y, z}))];
  }

  std::size_t memory_bytes() const;

 private:
  using VertexBlock = std::array<std::int32_t, kBlockCells>;

  void apply(const MomentCell& cell, const SurfacePatch& patch, int sign);
  std::int32_t vertex_at(GridIndex at);
  void evaluate(FieldVertex& vertex);
  void find_case(FieldVertex& vertex);

  BlockTable table_;
  std::deque<VertexBlock> blocks_;
  ChunkedPool<FieldVertex> vertices_;
  std::vector<std::int32_t> changed_;
};

}  // namespace linescope
