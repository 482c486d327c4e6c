// A small dense box of grid places that a line, or a part of it, touches: points are sorted into it without a
// search and without a branch. (Noise decides from point to point which of two cubes is hit; no branch
// predictor guesses that.)
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "viewer/surface/cell_moments.hpp"
#include "viewer/surface/line_quantizer.hpp"

namespace linescope {

/// Where a line's points lie: grid places from the line's corner, both ends included.
struct TileBox {
  GridIndex low, high;
  int nx() const { return high.x - low.x + 1; }
  int ny() const { return high.y - low.y + 1; }
  int nz() const { return high.z - low.z + 1; }
  std::int64_t volume() const { return std::int64_t{nx()} * ny() * nz(); }
  GridIndex place(int i) const {
    return {low.x + i % nx(), low.y + i / nx() % ny(), low.z + i / nx() / ny()};
  }
};

inline constexpr int kMaxTile = 2048;

/// The box of the grid places within the bounds; `shift` (in steps) is added first.
TileBox box_of(const PlacedBounds& bounds, std::int32_t shift);

/// Adds points to the moments of their cubes, tile[box.place] ...; refused points add nothing. The plain
/// form, and the one used where the processor can (AVX2): integers, so the same sums.
void add_moments_portable(std::span<const PlacedPoint> points, const TileBox& box, MomentSums* tile);
void add_moments(std::span<const PlacedPoint> points, const TileBox& box, MomentSums* tile);

/// Counts usable points per grid place after adding `shift` steps.
void count_points(std::span<const PlacedPoint> points, std::int32_t shift, const TileBox& box,
                  std::uint32_t* tile);

/// Calls `work(part, box)` for parts of the line whose boxes fit a tile: the whole line as a rule, halves of
/// it where wild points stretch the box.
template <class Work>
void for_each_tile(std::span<const PlacedPoint> points, const PlacedBounds& bounds, std::int32_t shift,
                   const Work& work) {
  if (bounds.refused == points.size()) return;
  const TileBox box = box_of(bounds, shift);
  if (box.volume() <= kMaxTile) return work(points, box);
  const auto first = points.first(points.size() / 2), second = points.subspan(points.size() / 2);
  for_each_tile(first, bounds_of(first), shift, work);
  for_each_tile(second, bounds_of(second), shift, work);
}

}  // namespace linescope
