// The equations of four patches at a time, one in each lane of the processor's registers: what one waits for
// in solving six unknowns is the result before, and four at a time wait no longer than one.
#pragma once

#include <array>
#include <cstddef>

#include "viewer/surface/mesher_options.hpp"

namespace linescope {

/// A column from the middle of the neighbourhood's middle column; all zeros: no points.
struct WindowColumn {
  double w = 0, points = 0;
  double u = 0, v = 0, h = 0;                             ///< means
  double uu = 0, uv = 0, vv = 0, uh = 0, vh = 0, hh = 0;  ///< covariance of the points
  bool empty() const { return w == 0; }
};

/// What is believed about d, e, f before the columns are looked at.
struct CurvaturePrior {
  std::array<double, 3> mean{};
  double variance = 0;  ///< of d and f, intervals^-2; e has four times as much
};

/// Height = a + b u + c v + d u^2 + e uv + f v^2.
using PatchCoefficients = std::array<double, 6>;

struct PatchSolution {
  PatchCoefficients k{};
  double variance_factor = 0;  ///< of the height in the middle, per unit variance of a unit weight
};

inline constexpr std::size_t kPatchLanes = 4;

struct PatchEquations {
  const std::array<WindowColumn, 9>* columns = nullptr;
  CurvaturePrior prior;
};

/// Least squares over the columns, with `unit_variance` that of a point of unit weight. A patch's solution
/// does not depend on the other three. The plain form, and the one used where the processor can (AVX2): the
/// same bits (no fused multiply-add).
using FourPatches = std::array<PatchEquations, kPatchLanes>;
using FourSolutions = std::array<PatchSolution, kPatchLanes>;
FourSolutions solve_patches_portable(const FourPatches& patches, LocalFit fit, double unit_variance);
FourSolutions solve_patches(const FourPatches& patches, LocalFit fit, double unit_variance);

}  // namespace linescope
