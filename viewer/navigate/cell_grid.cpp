#include "viewer/navigate/cell_grid.hpp"

namespace linescope {

std::int32_t CellGrid::find_or_make(const CellIndex& c) {
  const std::uint64_t key = key_of(c);
  std::int32_t block = find_block(key);
  if (block == kNone) block = make_block(key);
  std::int32_t& cell = blocks_[static_cast<std::size_t>(block)][within(c)];
  if (cell == kNone) cell = next_cell_++;
  return cell;
}

void CellGrid::clear() {
  *this = CellGrid(cell_size_);
}

void CellGrid::place(const Slot& slot) {
  std::size_t i = first_slot(slot.key);
  while (slots_[i].key != kFree) i = (i + 1) & (slots_.size() - 1);
  slots_[i] = slot;
}

std::int32_t CellGrid::make_block(std::uint64_t key) {
  // Half full at most, so that a search for an absent block ends soon.
  if (2 * (blocks_.size() + 1) > slots_.size()) {
    std::vector<Slot> old(slots_.size() * 2);
    old.swap(slots_);
    for (const Slot& slot : old)
      if (slot.key != kFree) place(slot);
  }
  const auto number = static_cast<std::int32_t>(blocks_.size());
  blocks_.emplace_back().fill(kNone);
  place({key, number});
  return number;
}

}  // namespace linescope
