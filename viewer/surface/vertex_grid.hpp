// 3D grid arrangement of the thesis (4.3.2 (1)): every point marks the grid vertex nearest to it.
//
// Per axis the point is compared with the midpoint between its two grid planes; beyond it the upper plane
// wins. The grid is anchored at the frame's origin, so it does not depend on which points came first. Points
// per vertex are counted: the densities that the classical algorithm interpolates.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include "viewer/surface/block_table.hpp"
#include "viewer/surface/line_quantizer.hpp"

namespace linescope {

struct VertexBlock {
  std::array<std::uint32_t, kBlockCells> count{};  ///< points per vertex
  std::array<std::uint32_t, kBlockCells> sweep{};  ///< the sweep that last changed it
  std::array<std::uint8_t, 64> inside{};           ///< bit x of row (y, z): count > isovalue
  bool changed = false;                            ///< is among VertexGrid::changed()
};

class VertexGrid {
 public:
  /// `isovalue`: more points than this mark a vertex (0.5 for the thesis's 0/1 grid).
  VertexGrid(double isovalue, std::size_t max_memory) : isovalue_(isovalue), max_memory_(max_memory) {}

  void begin_sweep();

  /// So many more points at a vertex; |index| <= kGridLimit. False when there is no room for them.
  bool add(GridIndex vertex, std::uint32_t points);

  /// Takes back what came since the last begin_sweep(): how many points, or -1 when there is no sweep left.
  std::int64_t remove_last_sweep();

  void clear();

  BlockTable& table() { return table_; }
  const BlockTable& table() const { return table_; }
  VertexBlock& block(std::int32_t number) { return blocks_[static_cast<std::size_t>(number)]; }
  const VertexBlock& block(std::int32_t number) const { return blocks_[static_cast<std::size_t>(number)]; }

  /// Blocks in which a cube (by its lowest corner) may have changed its case since forget_changes().
  const std::vector<std::int32_t>& changed() const { return changed_; }
  void forget_changes();

  /// Points at a vertex of the block or of the block next to it: x, y, z from -8 to 15.
  std::uint32_t count_near(std::int32_t block, int x, int y, int z) const;

  std::size_t marked() const { return marked_; }
  std::size_t sweeps() const { return journal_.size(); }
  std::size_t memory_bytes() const;

 private:
  struct Change {
    std::int32_t block;
    std::int32_t local;
    std::uint32_t count_before;
  };

  std::int32_t block_at(GridIndex block);
  bool reserve_lower_blocks(GridIndex vertex);
  bool has_room() const;
  void set_count(std::int32_t block, int local, std::uint32_t count);
  void flag_changed(std::int32_t block, int local);

  double isovalue_;
  std::size_t max_memory_;
  BlockTable table_;
  std::deque<VertexBlock> blocks_;  // at least table_.size() of them; the rest waits for the next scan
  std::vector<std::vector<Change>> journal_;
  std::vector<std::int32_t> changed_;
  std::uint32_t sweep_ = 0;
  std::size_t marked_ = 0;
  std::size_t journal_bytes_ = 0;
  GridIndex last_coordinate_;
  std::int32_t last_block_ = BlockTable::kNone;
};

/// Steps to add to a point so that its cube's number is that of its nearest vertex: per axis, beyond the
/// midpoint of an interval the upper grid plane.
inline constexpr std::int32_t kToNearestVertex = kSteps / 2;

}  // namespace linescope
