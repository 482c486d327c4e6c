// What a cube of the sparse grid remembers of the points in it: sums, so that a point costs the same whether
// it is the first or the ten-millionth, and integers, so that the order of the points, and taking some back,
// cannot matter.
#pragma once

#include <array>
#include <cstdint>

#include "viewer/surface/block_table.hpp"

namespace linescope {

/// A cube's edge has so many fixed-point steps: 0.6 um at t = 1.27 mm.
inline constexpr int kStepBits = 11;
inline constexpr int kSteps = 1 << kStepBits;

/// Weight of a point with the typical standard deviation; others get 1 to 16.
inline constexpr int kTypicalWeight = 4;

/// Weighted moments about the cube's lowest corner, in steps.
struct MomentSums {
  std::int64_t w = 0;
  std::int64_t x = 0, y = 0, z = 0;
  std::int64_t xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  std::int64_t points = 0;

  void add(const MomentSums& other) {
    w += other.w;
    x += other.x;
    y += other.y;
    z += other.z;
    xx += other.xx;
    xy += other.xy;
    xz += other.xz;
    yy += other.yy;
    yz += other.yz;
    zz += other.zz;
    points += other.points;
  }
};

struct MomentCell {
  MomentSums sums;
  std::array<std::int64_t, 6>
      lines_apart{};  ///< sum over lines of (sum of the line)(the same)^T / its weight: xx xy xz yy yz zz
  std::array<std::int32_t, 3> towards{};  ///< sum over lines of the unit vector to the camera, 1/256
  std::int32_t lines = 0;                 ///< lines with a point here

  GridIndex at;
  std::int32_t block = BlockTable::kNone;
  std::uint32_t sweep = 0;     ///< the sweep that last changed it
  std::uint32_t line = 0;      ///< the line that last changed it ...
  std::int32_t line_slot = 0;  ///< ... and its place in that line's list
  bool changed = false;        ///< is among MomentGrid::changed()

  bool occupied() const { return sums.points != 0; }
};

/// The same as means, in units of the interval: what fits are made of.
struct CellStatistics {
  double weight = 0;
  double points = 0;
  std::array<double, 3> mean{};         ///< from the cube's lowest corner, 0..1
  std::array<double, 6> covariance{};   ///< of the points about the mean: xx xy xz yy yz zz
  std::array<double, 6> lines_apart{};  ///< weighted sum over lines of (their mean - the mean)(the same)^T
  std::array<double, 3> towards{};      ///< sum of unit vectors to the camera, one per line
  double lines = 0;
};

CellStatistics statistics_of(const MomentCell& cell);

}  // namespace linescope
