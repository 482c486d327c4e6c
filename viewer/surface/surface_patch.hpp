// The surface near one cube: a quadric (or a plane) over the cube's dominant axis, fitted to the moments of
// the cubes around.
//
// Over the axis h along which the normal points most, the surface is a height over the other two, u and v.
// The cubes of a column along h are merged, so that noise, which decides into which cube of the column a
// point falls, cannot select points. Of the nine columns around, mean height = a + b u + c v + d u^2 + e uv +
// f v^2 holds exactly between the means of height, u, v, u^2, uv and v^2 (they are linear in the
// coefficients): nine weighted equations, no point looked at twice. A weak prior holds curvature back where
// the columns do not show it (borders, first lines).
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "viewer/surface/cell_moments.hpp"
#include "viewer/surface/mesher_options.hpp"

namespace linescope {

/// A cube of the neighbourhood: its statistics, and where its lowest corner lies from the middle cube's
/// (intervals).
struct NearCell {
  const CellStatistics* statistics;
  std::array<int, 3> offset;
};

/// All cubes that may take part: columns 3x3 around the middle one, up to kPatchReach cubes up and down.
inline constexpr int kPatchReach = 3;
struct PatchColumn {
  std::array<NearCell, 2 * kPatchReach + 1> cells;  ///< the first `count` are set
  int count = 0;
  void add(const NearCell& cell) { cells[static_cast<std::size_t>(count++)] = cell; }
};

struct PatchInput {
  int axis = 2;                        ///< h: 0, 1 or 2; u and v are the next two, cyclically
  std::array<PatchColumn, 9> columns;  ///< (u, v) from (-1, -1), u running fastest; 4 is the middle
};

/// What is believed about d, e, f before the columns are looked at.
struct CurvaturePrior {
  std::array<double, 3> mean{};
  double variance = 0;  ///< of d and f, intervals^-2; e has four times as much
};

struct PatchOptions {
  LocalFit fit = LocalFit::quadric;
  double point_variance = 0;  ///< of a point with the typical weight, intervals^2
  double min_points = 24;
  double min_lines = 2;
};

/// The result, in intervals from the middle cube's lowest corner. Heights are given at the four corners (u,
/// v) = (0, 0), (1, 0), (0, 1), (1, 1) of the middle column.
struct SurfacePatch {
  int axis = 2;
  std::array<double, 4> height{};
  std::array<double, 3> normal{};     ///< unit, x y z, to the side it was seen from
  double deviation = 0;               ///< one standard deviation of the height along the normal
  double weight = 0;                  ///< of the middle column
  double points = 0;                  ///< in the middle column
  std::array<double, 3> centre{};     ///< mean of the middle column, x y z
  std::array<double, 3> curvature{};  ///< d, e, f
};

/// Nothing when there are too few points or lines, when they lie along a line, or when the axis turns out to
/// be wrong.
std::optional<SurfacePatch> fit_patch(const PatchInput& input, const CurvaturePrior& prior,
                                      const PatchOptions& options);

/// True when every column has a fair share of points: the patch then shows its curvature by itself.
bool has_all_columns(const PatchInput& input);

}  // namespace linescope
