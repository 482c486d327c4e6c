// What a cube of the sparse grid remembers of the points in it: sums, so that a point costs the same whether
// it is the first or the ten-millionth, and integers, so that the order of the points, and taking some back,
// cannot matter.
#pragma once

#include <array>
#include <cstdint>

namespace linescope {

/// Weighted moments about the cube's lowest corner, in steps (line_quantizer.hpp). Grouped as the processor
/// adds them.
struct alignas(32) MomentSums {
  std::array<std::int64_t, 4> first{};     ///< x y z and the weight itself
  std::array<std::int64_t, 4> squares{};   ///< xx yy zz; the fourth counts points
  std::array<std::int64_t, 4> products{};  ///< xy yz zx; the fourth counts points, too

  friend bool operator==(const MomentSums&, const MomentSums&) = default;

  std::int64_t weight() const { return first[3]; }
  std::int64_t points() const { return squares[3]; }

  void add(const MomentSums& other) {
    for (std::size_t i = 0; i < 4; ++i) {
      first[i] += other.first[i];
      squares[i] += other.squares[i];
      products[i] += other.products[i];
    }
  }
};

/// What tells lines apart: sums over the parts that lines have in a column of cubes. A part is all of a
/// line's points in the column, booked in the cube that holds most of them: noise splits a line over the
/// cubes of a column, and its mean within one of them would say little about where the line lies.
struct LineParts {
  std::array<std::int64_t, 4>
      first{};  ///< as MomentSums, about the lowest corner of the cube it is booked in
  std::array<std::int64_t, 6>
      second{};  ///< sum of (first of the part)(the same)^T / its weight: xx xy xz yy yz zz
  std::int64_t count = 0;

  void add(const std::array<std::int64_t, 4>& part);
};

/// Everything a cube knows; what an undo puts back.
struct CellContent {
  MomentSums sums;
  LineParts parts;
  std::array<std::int32_t, 3> towards{};  ///< sum over lines of the unit vector to the camera, 1/256
  std::int32_t lines = 0;                 ///< lines with a point here

  bool occupied() const { return sums.points() != 0; }
};

/// The same as means, in units of the interval: what fits are made of.
struct CellStatistics {
  double weight = 0;
  double points = 0;
  double lines = 0;
  std::array<double, 3> mean{};        ///< from the cube's lowest corner, 0..1
  std::array<double, 6> covariance{};  ///< of the points about the mean: xx xy xz yy yz zz
  std::array<double, 3> towards{};     ///< sum of unit vectors to the camera, one per line
  double parts = 0;                    ///< LineParts: how many,
  double parts_weight = 0;             ///< their weight,
  std::array<double, 3> parts_sum{};   ///< weighted sum of their means
  std::array<double, 6>
      parts_squares{};  ///< and of their means' squares, about the lowest corner: xx xy xz yy yz zz
};

CellStatistics statistics_of(const CellContent& cell);

}  // namespace linescope
