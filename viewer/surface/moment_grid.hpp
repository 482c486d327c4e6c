// The sparse grid of cubes with moments: takes lines in, knows what changed, takes the last sweep back.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "viewer/surface/cell_moments.hpp"
#include "viewer/surface/chunked_pool.hpp"
#include "viewer/surface/line_quantizer.hpp"
#include "viewer/surface/point_tile.hpp"
#include "viewer/surface/sparse_index.hpp"

namespace linescope {

struct MomentCell {
  CellContent content;
  std::array<std::int32_t, 27>
      near{};  ///< numbers of the cubes around (neighbour_slot), SparseIndex::kNone where none
  GridIndex at;
  std::uint32_t sweep = 0;     ///< the sweep that last changed it
  std::uint32_t line = 0;      ///< the line that last changed it ...
  std::int32_t line_slot = 0;  ///< ... and its place in that line's list
  bool changed = false;        ///< is among MomentGrid::changed()

  bool occupied() const { return content.occupied(); }
};

class MomentGrid {
 public:
  /// `interval` in mm, `max_memory` in bytes.
  MomentGrid(double interval, std::size_t max_memory);

  void begin_sweep();

  /// Adds a line's points to the cubes they lie in. `seen_from` in mm.
  /// Returns how many found room. Precondition: begin_sweep() was called.
  std::uint64_t add_line(const PlacedLine& line, const Eigen::Vector3d& seen_from);

  /// As VertexGrid::remove_last_sweep.
  std::int64_t remove_last_sweep();

  void clear();

  /// Cubes that changed since forget_changes(), each once.
  const std::vector<std::int32_t>& changed() const { return changed_; }
  void forget_changes();

  const MomentCell& cell(std::int32_t number) const { return cells_[number]; }
  std::size_t cell_count() const { return cells_.size(); }
  std::size_t occupied() const { return occupied_; }
  std::size_t sweeps() const { return sweep_begins_.size(); }
  std::size_t memory_bytes() const;

 private:
  /// A cube as it was before a sweep touched it, unless it was empty.
  struct CellBefore {
    std::int32_t cell = 0;
    CellContent content;
  };
  /// What the line being taken in has in a cube.
  struct LineCell {
    std::int32_t cell = 0;
    std::array<std::int64_t, 4> first{};  ///< as MomentSums
  };

  std::int32_t cell_at(GridIndex at);
  void link(const SparseIndex::Block& block, std::int32_t cell);
  bool add_to_cell(GridIndex at, const MomentSums& sums);
  void begin_line_in(std::int32_t cell);
  Eigen::Vector3d towards_camera(const Eigen::Vector3d& seen_from) const;
  void book_part(const LineCell& lowest, int axis);
  void flag_changed(std::int32_t cell);
  std::int64_t put_back(std::int32_t cell, const CellContent& before);

  double interval_;
  std::size_t max_memory_;
  SparseIndex index_;
  ChunkedPool<MomentCell> cells_;
  std::vector<std::int32_t> changed_;
  ChunkedPool<CellBefore> journal_;
  std::vector<std::int32_t> filled_;  // cubes that were empty before a sweep touched them
  struct SweepBegin {
    std::size_t journal, filled;
  };
  std::vector<SweepBegin> sweep_begins_;  // in journal_ and filled_
  MomentTile tile_;
  std::vector<LineCell> line_cells_;  // the line being taken in
  std::uint32_t sweep_ = 0;
  std::uint32_t line_ = 0;
  std::size_t occupied_ = 0;
};

}  // namespace linescope
