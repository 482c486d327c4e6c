// The sparse grid of cubes with moments: takes lines in, knows what changed, takes the last sweep back.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include "viewer/surface/block_table.hpp"
#include "viewer/surface/cell_moments.hpp"
#include "viewer/surface/chunked_pool.hpp"
#include "viewer/surface/mesher.hpp"

namespace linescope {

class MomentGrid {
 public:
  explicit MomentGrid(const MesherOptions& options);

  void begin_sweep();

  /// Adds the line's points to the cubes they lie in; counts what it refuses. Precondition: begin_sweep() was
  /// called. True when at least one point was used.
  bool add_line(const SurfaceLine& line, MesherCounters& counters);

  /// As VertexGrid::remove_last_sweep.
  std::int64_t remove_last_sweep();

  void clear();

  /// Cubes that changed since forget_changes(), each once.
  const std::vector<std::int32_t>& changed() const { return changed_; }
  void forget_changes();

  const MomentCell& cell(std::int32_t number) const { return cells_[number]; }
  std::size_t cell_count() const { return cells_.size(); }
  std::size_t occupied() const { return occupied_; }

  /// The cube at x, y, z (-8 to 15) from the lowest corner of a block: its number or BlockTable::kNone.
  std::int32_t cell_near(std::int32_t block, int x, int y, int z) const {
    const int slot = neighbour_slot(x >> kBlockBits, y >> kBlockBits, z >> kBlockBits);
    const std::int32_t at = table_.neighbours(block)[static_cast<std::size_t>(slot)];
    return at == BlockTable::kNone
               ? at
               : blocks_[static_cast<std::size_t>(at)][static_cast<std::size_t>(local_of({x, y, z}))];
  }

  std::size_t sweeps() const { return journal_.size(); }
  std::size_t memory_bytes() const;

 private:
  using CellBlock = std::array<std::int32_t, kBlockCells>;  ///< numbers of cubes or kNone
  struct LineCell {
    std::int32_t cell = 0;
    MomentSums sums;
  };

  std::int32_t cell_at(GridIndex at);
  std::int32_t block_at(GridIndex block);
  LineCell* line_cell(GridIndex at);
  void merge_line(const SurfaceLine& line);
  void merge(const LineCell& part, const Eigen::Vector3d& seen_from);
  void flag_changed(std::int32_t cell);

  double interval_;
  double max_distance_;
  float weight_scale_;
  std::size_t max_memory_;
  MesherOptions options_;
  BlockTable table_;
  std::deque<CellBlock> blocks_;
  ChunkedPool<MomentCell> cells_;
  std::vector<std::int32_t> changed_;
  std::vector<std::vector<std::pair<std::int32_t, MomentCell>>> journal_;
  std::vector<LineCell> line_cells_;  // the line being taken in
  std::uint32_t sweep_ = 0;
  std::uint32_t line_ = 0;
  std::size_t occupied_ = 0;
  std::size_t journal_bytes_ = 0;
  GridIndex last_coordinate_;
  std::int32_t last_block_ = BlockTable::kNone;
};

}  // namespace linescope
