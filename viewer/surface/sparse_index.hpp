// Where on the sparse grid a record lives: grid index to running number and back, with quick steps to the
// neighbours.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "viewer/surface/block_table.hpp"
#include "viewer/surface/chunked_pool.hpp"

namespace linescope {

class SparseIndex {
 public:
  static constexpr std::int32_t kNone = BlockTable::kNone;

  struct Block {
    std::array<std::int32_t, kBlockCells> number;  ///< of the record at each place, or kNone
    GridIndex at;                                  ///< its coordinate
    std::array<Block*, 27> near;                   ///< the blocks around (neighbour_slot), null where none
  };

  /// The block at a block coordinate, made when missing; the address stays valid until clear().
  Block& block(GridIndex coordinate);

  /// The same if it is there, or null.
  Block* find(GridIndex coordinate);

  /// The number at x, y, z (-8 to 15) from the lowest corner of a block.
  static std::int32_t near(const Block& block, int x, int y, int z) {
    const int slot = neighbour_slot(x >> kBlockBits, y >> kBlockBits, z >> kBlockBits);
    const Block* at = block.near[static_cast<std::size_t>(slot)];
    return at == nullptr ? kNone : at->number[static_cast<std::size_t>(local_of({x, y, z}))];
  }

  /// The numbers at a place of the block and at the 26 places around it, by neighbour_slot.
  static void numbers_around(const Block& block, GridIndex at, std::array<std::int32_t, 27>& numbers) {
    const auto next = [](std::int32_t i, std::int32_t step) { return (i & 7) + step; };
    std::size_t slot = 0;
    for (int dz = -1; dz <= 1; ++dz)
      for (int dy = -1; dy <= 1; ++dy) {
        const int y = next(at.y, dy), z = next(at.z, dz);
        const int row = local_of({0, y, z}), blocks = neighbour_slot(-1, y >> kBlockBits, z >> kBlockBits);
        for (int dx = -1; dx <= 1; ++dx) {
          const int x = next(at.x, dx);
          const Block* const owner = block.near[static_cast<std::size_t>(blocks + (x >> kBlockBits) + 1)];
          numbers[slot++] = owner == nullptr ? kNone : owner->number[static_cast<std::size_t>(row | (x & 7))];
        }
      }
  }

  /// The numbers at the corners of a cube (bit 0: x, 1: y, 2: z) that lies above `at` (step 1) or below it
  /// (step -1). `at` lies in the block.
  static std::array<std::int32_t, 8> corners(const Block& block, GridIndex at, int step) {
    const int x = at.x & 7, y = at.y & 7, z = at.z & 7, edge = step > 0 ? kBlockSize - 1 : 0;
    std::array<std::int32_t, 8> result{};
    if (x != edge && y != edge && z != edge) {  // about two of three: all in this block
      const auto own = static_cast<std::size_t>(local_of(at));
      constexpr std::array<std::size_t, 8> kWays{0, 1, 8, 9, 64, 65, 72, 73};
      for (std::size_t i = 0; i < 8; ++i)
        result[i] = block.number[step > 0 ? own + kWays[i] : own - kWays[i]];
      return result;
    }
    for (int i = 0; i < 8; ++i)
      result[static_cast<std::size_t>(i)] =
          near(block, x + step * (i & 1), y + step * (i >> 1 & 1), z + step * (i >> 2));
    return result;
  }

  /// Calls `visit(number)` for every record in an order that depends on the places only.
  template <class Visit>
  void for_each_ordered(Visit visit) {
    for (const std::int32_t block : table_.ordered())
      for (const std::int32_t number : blocks_[block].number)
        if (number != kNone) visit(number);
  }

  void clear();
  std::size_t memory_bytes() const { return table_.memory_bytes() + blocks_.size() * sizeof(Block); }

 private:
  BlockTable table_;
  ChunkedPool<Block> blocks_;
  GridIndex last_coordinate_;
  Block* last_ = nullptr;  // the block asked for last
};

}  // namespace linescope
