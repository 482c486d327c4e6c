// What the plain and the vector form of the tile share. Internal to viewer/surface.
#pragma once

#include <array>

#include "viewer/surface/point_tile.hpp"

namespace linescope::tile_detail {

/// Where a box begins, in steps, and what a step from one of its places to the next is worth.
struct TileFrame {
  TileFrame(const TileBox& box, std::int32_t shift)
      : origin{(box.low.x << kStepBits) - shift, (box.low.y << kStepBits) - shift,
               (box.low.z << kStepBits) - shift},
        stride{1, box.nx(), box.nx() * box.ny()} {}
  std::array<std::int32_t, 3> origin;
  std::array<int, 3> stride;

  std::size_t place_of(const PlacedBlock& block, std::size_t lane) const {
    const int x = (block.x[lane] - origin[0]) >> kStepBits, y = (block.y[lane] - origin[1]) >> kStepBits,
              z = (block.z[lane] - origin[2]) >> kStepBits;
    return static_cast<std::size_t>(x + stride[1] * y + stride[2] * z);
  }
};

/// As count_points. Precondition: has_avx2_and_bits().
void count_points_avx2(std::span<const PlacedBlock> blocks, std::int32_t shift, const TileBox& box,
                       std::uint32_t* tile);

}  // namespace linescope::tile_detail
