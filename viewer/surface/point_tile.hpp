// A small dense box of grid places that a line, or a part of it, touches: points are sorted into it without a
// search. Of sixteen points all that lie in one place are taken at once, place after place: noise decides
// from point to point which of two cubes is hit, but neighbours on a line rarely lie in more than three.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "viewer/surface/cell_moments.hpp"
#include "viewer/surface/point_placement.hpp"

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
  int index_of(GridIndex at) const { return at.x - low.x + nx() * (at.y - low.y + ny() * (at.z - low.z)); }
};

inline constexpr int kMaxTile = 2048;

/// The box of the grid places within the bounds; `shift` (in steps) is added first.
TileBox box_of(const PlacedBounds& bounds, std::int32_t shift);

/// Counts usable points per grid place after adding `shift` steps. The plain form, and the one used where the
/// processor can (AVX2): the same counts.
void count_points_portable(std::span<const PlacedBlock> blocks, std::int32_t shift, const TileBox& box,
                           std::uint32_t* tile);
void count_points(std::span<const PlacedBlock> blocks, std::int32_t shift, const TileBox& box,
                  std::uint32_t* tile);

/// A block as its sums are made from: steps from the middle of the cube, the same weighted, weight and count
/// in one number, and the place (refused points: one that cannot be).
struct alignas(32) PreparedBlock {
  std::array<std::array<std::int16_t, kPlacedPoints>, 3> at, weighted;
  std::array<std::int16_t, kPlacedPoints> counted, place;
};

/// Sums the moments of points per cube.
class MomentTile {
 public:
  struct Cube {
    int place = 0;  ///< TileBox::place
    MomentSums sums;
  };

  MomentTile();

  /// The cubes in which points of a batch lie, each once; no more than kBatch blocks, within the box. Valid
  /// until the next call. The plain form, and the one used where the processor can (AVX2): integers, so the
  /// same sums.
  std::span<const Cube> sums_portable(std::span<const PlacedBlock> batch, const TileBox& box);
  std::span<const Cube> sums(std::span<const PlacedBlock> batch, const TileBox& box);

  /// Blocks whose sums fit into 32 bits, whatever the points.
  static constexpr std::size_t kBatch = 63;

 private:
  /// A block in which points of a place are, and the mention of that place before this one.
  struct Mention {
    std::uint16_t block, before;
  };
  static constexpr std::uint16_t kNobody = 0xFFFF;

  void list_places(std::span<const PlacedBlock> batch, const TileBox& box);
  void add_up_places();

  std::vector<std::uint16_t> last_;  // per place: its last mention (or number in cubes_); else kNobody
  std::vector<std::uint16_t> touched_;
  std::vector<Mention> mentions_;
  std::vector<PreparedBlock> prepared_;
  std::vector<Cube> cubes_;
};

/// Calls `work(part, box)` for parts of the line whose boxes fit a tile: the whole line as a rule, halves of
/// it, at last single points, where wild points stretch the box.
template <class Work>
void for_each_tile(std::span<const PlacedBlock> blocks, const PlacedBounds& bounds, std::int32_t shift,
                   const Work& work) {
  if (bounds.usable == 0) return;
  const TileBox box = box_of(bounds, shift);
  if (box.volume() <= kMaxTile) return work(blocks, box);
  if (blocks.size() > 1) {
    const auto first = blocks.first(blocks.size() / 2), second = blocks.subspan(blocks.size() / 2);
    for_each_tile(first, bounds_of(first), shift, work);
    for_each_tile(second, bounds_of(second), shift, work);
    return;
  }
  for (std::size_t lane = 0; lane < kPlacedPoints; ++lane) {
    PlacedBlock single = blocks[0];
    for (std::size_t other = 0; other < kPlacedPoints; ++other)
      if (other != lane) single.weight[other] = 0;
    for_each_tile(std::span<const PlacedBlock>(&single, 1), bounds_of({&single, 1}), shift, work);
  }
}

}  // namespace linescope
