// Columns of cubes, merged: what the cubes say that lie one on the other without a gap.
//
// Noise decides into which cube of a column a point falls, so only the column as a whole means something. A
// column takes part in up to nine patches: it is merged once for all of them.
#pragma once

#include <array>
#include <cstdint>

#include "viewer/surface/chunked_pool.hpp"
#include "viewer/surface/moment_grid.hpp"

namespace linescope {

/// A patch looks so many cubes up and down from its middle.
inline constexpr int kPatchReach = 3;

/// Cubes one on the other along an axis h, lowest first; u and v are the next two axes, cyclically.
struct CubeStack {
  std::array<const CellStatistics*, 2 * kPatchReach + 1> cells;  ///< the first `count` are set
  int count = 0;
  void add(const CellStatistics* cell) { cells[static_cast<std::size_t>(count++)] = cell; }
};

/// Their points together, in intervals from the lowest corner of the lowest cube.
struct ColumnStatistics {
  double weight = 0, points = 0;
  double u = 0, v = 0, h = 0;                             ///< means
  double uu = 0, uv = 0, vv = 0, uh = 0, vh = 0, hh = 0;  ///< covariance of the points
  double most_lines = 0;                                  ///< in one of the cubes
  double lines = 0;                                       ///< summed over the cubes
  std::array<double, 3> towards{};                        ///< x y z, sum of one unit vector per line
  double parts = 0, parts_weight = 0;                     ///< LineParts: how many, their weight,
  double parts_u = 0, parts_v = 0, parts_h = 0;           ///< weighted sums of their means
  double parts_uu = 0, parts_uv = 0, parts_vv = 0, parts_uh = 0, parts_vh = 0, parts_hh = 0;  ///< and squares
};

/// Cubes whose bit is set in `excluded` are left out. Nothing but zeros when none is left.
ColumnStatistics merged(const CubeStack& stack, int axis, unsigned excluded = 0);

/// A longest stretch of occupied cubes, if it is short enough for a height.
struct ColumnRun {
  CubeStack stack;
  int middle = -1;  ///< the cube, from the lowest, in which the mean lies and which can carry a patch; or -1
  bool merged = false;          ///< `statistics` is set
  ColumnStatistics statistics;  ///< see ColumnRuns::statistics
};

/// Finds runs, each once in a round. During a round the grid must not change.
class ColumnRuns {
 public:
  void begin_round(const MomentGrid& grid);

  CellStatistics& cell(std::int32_t number) { return cells_[number].statistics; }
  const CellStatistics& cell(std::int32_t number) const { return cells_[number].statistics; }
  bool occupied(std::int32_t number) const { return cells_[number].statistics.points != 0; }

  struct Place {
    ColumnRun* run = nullptr;  ///< null: longer than any that carries a patch
    int height = 0;            ///< of the cube in it
  };
  /// The run through an occupied cube. Valid during the round.
  Place find(const MomentGrid& grid, std::int32_t cell, int axis);

  void clear() { cells_.clear(), runs_.clear(); }
  std::size_t memory_bytes() const { return cells_.size() * sizeof(Cell) + most_runs_ * sizeof(ColumnRun); }

 private:
  /// Longer ones reach the end of what a patch looks at, whichever cube is the middle: the surface runs along
  /// the axis there and is no height.
  static constexpr int kLongest = 2 * kPatchReach - 1;
  static constexpr std::int32_t kTooLong = -1;
  struct Cell {
    CellStatistics statistics;
    std::array<std::uint32_t, 3> round{};  ///< per axis: when `run` was found
    std::array<std::int32_t, 3> run{};     ///< number in runs_, or kTooLong
    std::array<std::int8_t, 3> height{};
  };

  std::int32_t next(const MomentGrid& grid, std::int32_t cell, std::size_t slot) const;
  bool known_too_long(std::int32_t cell, std::size_t axis) const;
  void make_run(const MomentGrid& grid, std::int32_t cell, int axis);
  void make_run(const std::int32_t* cells, int count, int axis);

  ChunkedPool<Cell> cells_;  // by number of cube
  ChunkedPool<ColumnRun> runs_;
  std::size_t most_runs_ = 0;
  std::uint32_t round_ = 0;
};

}  // namespace linescope
