// The sparse grid: space in blocks of 8x8x8, numbered as they are first needed. Memory follows the surface,
// not its box.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace linescope {

/// A place in the grid (a cell, a grid vertex or a block).
struct GridIndex {
  std::int32_t x = 0, y = 0, z = 0;
  friend bool operator==(const GridIndex&, const GridIndex&) = default;
  friend GridIndex operator+(GridIndex a, GridIndex b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
};

inline constexpr int kBlockBits = 3;
inline constexpr int kBlockSize = 1 << kBlockBits;
inline constexpr int kBlockCells = kBlockSize * kBlockSize * kBlockSize;

/// Grid indices must lie within +-kGridLimit, so that a block's three coordinates fit into one key.
inline constexpr std::int32_t kGridLimit = (1 << 22) - 16;

constexpr GridIndex block_of(GridIndex i) {
  return {i.x >> kBlockBits, i.y >> kBlockBits, i.z >> kBlockBits};
}

/// Place within the block, x running fastest.
constexpr int local_of(GridIndex i) {
  return (i.x & 7) | (i.y & 7) << 3 | (i.z & 7) << 6;
}
constexpr GridIndex grid_of(GridIndex block, int local) {
  return {block.x * kBlockSize + (local & 7), block.y * kBlockSize + (local >> 3 & 7),
          block.z * kBlockSize + (local >> 6)};
}

/// Number of the neighbour at (dx, dy, dz), each -1, 0 or 1, in BlockTable::neighbours.
constexpr int neighbour_slot(int dx, int dy, int dz) {
  return (dx + 1) + 3 * (dy + 1) + 9 * (dz + 1);
}

/// Block coordinates to running numbers 0, 1, 2 ... (what a block holds lives in arrays of the owner, by that
/// number). Every block knows its 26 neighbours, so that walking over a block border needs no search.
class BlockTable {
 public:
  static constexpr std::int32_t kNone = -1;
  using Neighbours = std::array<std::int32_t, 27>;  ///< running numbers or kNone; slot 13 is the block itself

  std::int32_t find(GridIndex block) const;

  /// The block's number; `added` says whether it is new.
  std::int32_t find_or_add(GridIndex block, bool& added);

  GridIndex coordinate(std::int32_t number) const { return coordinates_[static_cast<std::size_t>(number)]; }
  const Neighbours& neighbours(std::int32_t number) const {
    return neighbours_[static_cast<std::size_t>(number)];
  }
  std::size_t size() const { return coordinates_.size(); }

  /// All numbers, ordered by coordinate (z, y, x): the same blocks in the same order, however they came to
  /// be.
  const std::vector<std::int32_t>& ordered();

  void clear();
  std::size_t memory_bytes() const;

 private:
  static std::uint64_t key_of(GridIndex block);
  std::size_t slot_of(std::uint64_t key) const;
  void grow();
  void link(std::int32_t number);

  struct Slot {
    std::uint64_t key = 0;
    std::int32_t number = kNone;
  };
  std::vector<Slot> slots_;  // open addressing, a power of two long, at most half full
  std::vector<GridIndex> coordinates_;
  std::vector<Neighbours> neighbours_;
  std::vector<std::int32_t> ordered_;
};

}  // namespace linescope
