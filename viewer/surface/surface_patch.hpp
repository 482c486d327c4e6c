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

#include "viewer/surface/column_runs.hpp"
#include "viewer/surface/mesher_options.hpp"
#include "viewer/surface/patch_solver.hpp"

namespace linescope {

/// A column of the neighbourhood.
struct PatchColumn {
  const CubeStack* stack = nullptr;              ///< null: no points there
  const ColumnStatistics* statistics = nullptr;  ///< of all of it
  int base = 0;                                  ///< height of the lowest cube above the middle one
};

struct PatchInput {
  int axis = 2;                        ///< h: 0, 1 or 2; u and v are the next two, cyclically
  std::array<PatchColumn, 9> columns;  ///< (u, v) from (-1, -1), u running fastest; 4 is the middle
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

/// All nine columns, and what they say together.
struct PatchWindow {
  std::array<WindowColumn, 9> columns{};
  double weight = 0, points = 0, lines = 0, best_column = 0;
  double spread = 0;      ///< variance across the narrowest direction of u, v
  double axis_share = 0;  ///< square of the normal's component along h, from the covariance of all points
};

/// One fit, in steps: what curvature to believe in may not be known at first, and equations are solved four
/// at a time.
class PatchFit {
 public:
  /// Looks at the columns. Both must stay as they are until patch() was called.
  void begin(const PatchInput& input, const PatchOptions& options);

  /// False when there are too few points or lines, when they lie along a line, or when the surface does not
  /// look along the axis: there is no patch, whatever the curvature.
  bool possible() const;

  /// True when every column has a fair share of points: the patch then shows its curvature by itself.
  bool has_all_columns() const;

  void believe(const CurvaturePrior& prior) { prior_ = prior; }
  PatchEquations equations() const { return {&window_.columns, prior_}; }

  /// Nothing when wild cubes left too little, or when the axis turns out to be wrong.
  /// Precondition: possible(); `found` solves equations().
  std::optional<SurfacePatch> patch(PatchSolution found);

 private:
  PatchSolution solved_again() const;

  const PatchInput* input_ = nullptr;
  const PatchOptions* options_ = nullptr;
  CurvaturePrior prior_;
  PatchWindow window_;
};

/// Of a point with unit weight.
double unit_variance(const PatchOptions& options);

}  // namespace linescope
