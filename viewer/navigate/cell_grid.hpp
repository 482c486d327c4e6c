// A sparse grid of cubes: from a place to the running number of its cell, in constant time.
//
// Cells are grouped in blocks of 8 x 8 x 8; a hash table finds the block, an array within it the cell. A
// neighbourhood of cells touches few blocks, so a look-up is mostly an array access. One thread may change it
// while nobody reads.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace linescope {

using CellIndex = Eigen::Vector3i;

class CellGrid {
 public:
  static constexpr std::int32_t kNone = -1;
  static constexpr int kLargestIndex = 1 << 22;  ///< |index| per axis below this

  explicit CellGrid(double cell_size) : cell_size_(cell_size), inverse_(1 / cell_size) {}

  double cell_size() const { return cell_size_; }
  std::int32_t size() const { return next_cell_; }

  CellIndex cell_of(const Eigen::Vector3d& p) const {
    return {static_cast<int>(std::floor(p.x() * inverse_)), static_cast<int>(std::floor(p.y() * inverse_)),
            static_cast<int>(std::floor(p.z() * inverse_))};
  }
  bool holds(const Eigen::Vector3d& p) const {
    return (p * inverse_).cwiseAbs().maxCoeff() < static_cast<double>(kLargestIndex);
  }
  Eigen::Vector3d centre_of(const CellIndex& c) const {
    return (c.cast<double>() + Eigen::Vector3d::Constant(0.5)) * cell_size_;
  }

  /// Number of the cell, kNone where none was made.
  std::int32_t find(const CellIndex& c) const {
    const std::int32_t block = find_block(key_of(c));
    return block == kNone ? kNone : blocks_[static_cast<std::size_t>(block)][within(c)];
  }

  /// Number of the cell, made with the next running number where there was none.
  std::int32_t find_or_make(const CellIndex& c);

  void clear();

  /// Calls visit(number, index) for every cell made in the box between two indices (both included), in a
  /// fixed order.
  template <class Visit>
  void visit_box(const CellIndex& low, const CellIndex& high, Visit&& visit) const;

 private:
  using Block = std::array<std::int32_t, 512>;
  struct Slot {
    std::uint64_t key = kFree;
    std::int32_t block = kNone;
  };
  static constexpr std::uint64_t kFree = ~std::uint64_t{0};

  static std::size_t within(const CellIndex& c) {
    return static_cast<std::size_t>((c.z() & 7) << 6 | (c.y() & 7) << 3 | (c.x() & 7));
  }
  static std::uint64_t part(int i) { return static_cast<std::uint64_t>((i >> 3) + (1 << 20)) & 0x1fffff; }
  static std::uint64_t key_of(const CellIndex& c) {
    return part(c.x()) | part(c.y()) << 21 | part(c.z()) << 42;
  }
  std::size_t first_slot(std::uint64_t key) const {
    return static_cast<std::size_t>((key * 0x9E3779B97F4A7C15ull) >> 20) & (slots_.size() - 1);
  }
  std::int32_t find_block(std::uint64_t key) const {
    for (std::size_t i = first_slot(key);; i = (i + 1) & (slots_.size() - 1)) {
      if (slots_[i].key == key) return slots_[i].block;
      if (slots_[i].key == kFree) return kNone;
    }
  }
  void place(const Slot& slot);
  std::int32_t make_block(std::uint64_t key);

  double cell_size_;
  double inverse_;
  std::vector<Slot> slots_ = std::vector<Slot>(64);
  std::vector<Block> blocks_;
  std::int32_t next_cell_ = 0;
};

template <class Visit>
void CellGrid::visit_box(const CellIndex& low, const CellIndex& high, Visit&& visit) const {
  for (int bz = low.z() >> 3; bz <= high.z() >> 3; ++bz)
    for (int by = low.y() >> 3; by <= high.y() >> 3; ++by)
      for (int bx = low.x() >> 3; bx <= high.x() >> 3; ++bx) {
        const CellIndex corner(bx * 8, by * 8, bz * 8);
        const std::int32_t number = find_block(key_of(corner));
        if (number == kNone) continue;
        const Block& block = blocks_[static_cast<std::size_t>(number)];
        const CellIndex from = low.cwiseMax(corner);
        const CellIndex to = high.cwiseMin(corner + CellIndex::Constant(7));
        for (int z = from.z(); z <= to.z(); ++z)
          for (int y = from.y(); y <= to.y(); ++y)
            for (int x = from.x(); x <= to.x(); ++x) {
              const CellIndex c(x, y, z);
              if (const std::int32_t cell = block[within(c)]; cell != kNone) visit(cell, c);
            }
      }
}

}  // namespace linescope
