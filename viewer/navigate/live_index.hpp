// The scanned surface, cut into cells of a sparse grid, ready for "what lies near here" at any moment.
//
// A cell holds sums over all its points (the plain normal needs nothing else) and its newest segments with
// their points. The number of segments per cell is bounded, so a query's time is bounded however often a
// place is scanned again; what had to go is counted. Object's frame, millimetres. One copy: thread safety
// comes from LeftRight around it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/result.hpp"
#include "viewer/navigate/cell_grid.hpp"
#include "viewer/navigate/line_segments.hpp"
#include "viewer/navigate/moments.hpp"

namespace linescope {

struct LiveIndexOptions {
  double cell_size = 1.27;     ///< mm
  int segments_per_cell = 32;  ///< newest ones kept: four sweeps of a normal scan
  int cells = 400'000;         ///< at most: a surface of 0.6 square metres
  double plane_reach =
      2.0;  ///< of the plain normal: its weights fall to zero at this distance, mm; at most 1.5 cells
  int plane_points = 24;  ///< fewer points than this give no plain normal
  LineSegmentOptions segments;
};

Result<void> validate(const LiveIndexOptions& options);

/// What happened to the points that came in, since the last clear.
struct IndexCounts {
  std::uint64_t lines = 0;              ///< taken
  std::uint64_t points = 0;             ///< taken
  std::uint64_t lines_rejected = 0;     ///< no usable point, or a viewing direction that is none
  std::uint64_t points_not_finite = 0;  ///< or metres away from the object's origin
  std::uint64_t points_wild = 0;        ///< off their own line's course within a cell
  std::uint64_t points_no_room = 0;     ///< the index has as many cells as it may
  std::uint64_t points_replaced = 0;    ///< pushed out by newer lines through the same cell
};

/// What the index knows of a line.
struct LineInfo {
  std::uint64_t id = 0;
  Nanoseconds time = 0;
  Eigen::Vector3f view = -Eigen::Vector3f::UnitZ();
};

class LiveIndex {
 public:
  explicit LiveIndex(const LiveIndexOptions& options) : options_(options), grid_(options.cell_size) {}

  const LiveIndexOptions& options() const { return options_; }
  const CellGrid& grid() const { return grid_; }

  /// Takes a line already cut by a LineCutter with this grid. `unusable` is the cutter's count.
  void add(const LineInfo& line, const std::vector<CutSegment>& segments, std::uint64_t unusable);
  void reject_line(std::uint64_t points) { ++counts_.lines_rejected, counts_.points_not_finite += points; }
  void clear();

  const IndexCounts& counts() const { return counts_; }
  const LineInfo& line(std::uint32_t place) const { return lines_[place]; }
  bool empty() const { return counts_.lines == 0; }

  /// The plain normal (target T13): plane through all points near `place`, the near ones weighing more; the
  /// cells' sums serve, no point is touched. Out of the surface. Nothing where there are too few points.
  std::optional<FittedPlane> plane_near(const Eigen::Vector3d& place) const;

  /// The same over a window of `half_width` cells to every side with equal weights: to look across a gap.
  std::optional<FittedPlane> wide_plane_near(const Eigen::Vector3d& place, int half_width) const;

  /// Mean viewing direction of the points within some `radius`; nothing where there are none.
  std::optional<Eigen::Vector3d> view_near(const Eigen::Vector3d& place, double radius) const;

  /// visit(segments, next) for every cell that reaches into the ball; the newest segment is the one before
  /// `next`.
  template <class Visit>
  void visit_cells(const Eigen::Vector3d& centre, double radius, Visit&& visit) const;

  /// Appends the points whose distance from `centre` lies in [inner, outer].
  void collect_shell(const Eigen::Vector3d& centre, double inner, double outer,
                     std::vector<Eigen::Vector3f>& out) const;

 private:
  struct CellLines {
    std::vector<Segment> segments;
    std::vector<std::vector<Eigen::Vector3f>> points;
    std::size_t next = 0;  ///< where the next segment goes once the cell is full
  };
  struct CellSums {
    Moments moments;
    Eigen::Vector3d view_sum = Eigen::Vector3d::Zero();
  };

  void put(CellLines& cell, const Segment& segment, const std::vector<Eigen::Vector3f>& points);
  std::optional<FittedPlane> oriented_plane(const Moments& sum, const Eigen::Vector3d& view,
                                            const Eigen::Vector3d& place) const;

  LiveIndexOptions options_;
  CellGrid grid_;
  std::vector<CellSums> sums_;
  std::vector<CellLines> cells_;
  std::vector<LineInfo> lines_;
  IndexCounts counts_;
};

template <class Visit>
void LiveIndex::visit_cells(const Eigen::Vector3d& centre, double radius, Visit&& visit) const {
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(radius);
  const double far = radius + 0.8661 * options_.cell_size;  // half a cell's diagonal
  grid_.visit_box(grid_.cell_of(centre - reach), grid_.cell_of(centre + reach),
                  [&](std::int32_t number, const CellIndex& c) {
                    if ((grid_.centre_of(c) - centre).squaredNorm() > far * far) return;
                    const CellLines& cell = cells_[static_cast<std::size_t>(number)];
                    visit(std::span<const Segment>(cell.segments), cell.next);
                  });
}

}  // namespace linescope
