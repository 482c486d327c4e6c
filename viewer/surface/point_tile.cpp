#include "viewer/surface/point_tile.hpp"

#include "common/processor.hpp"
#include "viewer/surface/point_tile_detail.hpp"

namespace linescope {
namespace {

using tile_detail::TileFrame;

void add_point(const PlacedBlock& block, std::size_t lane, MomentSums& sums) {
  constexpr std::int32_t mask = kSteps - 1;
  const std::array<std::int32_t, 4> place{block.x[lane] & mask, block.y[lane] & mask, block.z[lane] & mask,
                                          1};
  const std::array<std::int32_t, 4> turned{place[1], place[2], place[0], 1};
  for (std::size_t i = 0; i < 4; ++i) {
    const std::int32_t weighted = block.weight[lane] * place[i];
    const std::int32_t counted = i == 3 ? 1 : weighted;
    sums.first[i] += weighted;
    sums.squares[i] += counted * place[i];
    sums.products[i] += counted * turned[i];
  }
}

}  // namespace

TileBox box_of(const PlacedBounds& bounds, std::int32_t shift) {
  const auto place = [shift](const std::array<std::int32_t, 3>& at) {
    return GridIndex{(at[0] + shift) >> kStepBits, (at[1] + shift) >> kStepBits,
                     (at[2] + shift) >> kStepBits};
  };
  return {place(bounds.low), place(bounds.high)};
}

void count_points_portable(std::span<const PlacedBlock> blocks, std::int32_t shift, const TileBox& box,
                           std::uint32_t* tile) {
  const TileFrame frame(box, shift);
  for (const PlacedBlock& block : blocks)
    for (std::size_t lane = 0; lane < kPlacedPoints; ++lane)
      if (block.weight[lane] != 0) ++tile[frame.place_of(block, lane)];
}

void count_points(std::span<const PlacedBlock> blocks, std::int32_t shift, const TileBox& box,
                  std::uint32_t* tile) {
#if defined(__x86_64__)
  if (has_avx2_and_bits()) return tile_detail::count_points_avx2(blocks, shift, box, tile);
#endif
  count_points_portable(blocks, shift, box, tile);
}

MomentTile::MomentTile()
    : last_(kMaxTile, kNobody),
      touched_(kMaxTile + 1),
      mentions_(kBatch * kPlacedPoints + 1),
      prepared_(kBatch) {}

std::span<const MomentTile::Cube> MomentTile::sums_portable(std::span<const PlacedBlock> batch,
                                                            const TileBox& box) {
  cubes_.clear();
  const TileFrame frame(box, 0);
  for (const PlacedBlock& block : batch)
    for (std::size_t lane = 0; lane < kPlacedPoints; ++lane) {
      if (block.weight[lane] == 0) continue;
      const std::size_t place = frame.place_of(block, lane);
      if (last_[place] == kNobody) {
        last_[place] = static_cast<std::uint16_t>(cubes_.size());
        cubes_.push_back({static_cast<int>(place), {}});
      }
      add_point(block, lane, cubes_[last_[place]].sums);
    }
  for (const Cube& cube : cubes_) last_[static_cast<std::size_t>(cube.place)] = kNobody;
  return cubes_;
}

std::span<const MomentTile::Cube> MomentTile::sums(std::span<const PlacedBlock> batch, const TileBox& box) {
#if defined(__x86_64__)
  if (has_avx2_and_bits()) {
    list_places(batch, box);
    add_up_places();
    return cubes_;
  }
#endif
  return sums_portable(batch, box);
}

}  // namespace linescope
