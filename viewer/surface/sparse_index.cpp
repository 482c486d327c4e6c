#include "viewer/surface/sparse_index.hpp"

namespace linescope {

SparseIndex::Block& SparseIndex::block(GridIndex coordinate) {
  if (last_ != nullptr && last_coordinate_ == coordinate) return *last_;
  bool added = false;
  const std::int32_t number = table_.find_or_add(coordinate, added);
  if (added) {
    Block& fresh = blocks_[blocks_.add()];
    fresh.number.fill(kNone);
    fresh.at = coordinate;
    for (std::size_t slot = 0; slot < 27; ++slot) {
      const std::int32_t other = table_.neighbours(number)[slot];
      fresh.near[slot] = other == kNone ? nullptr : &blocks_[other];
      if (other != kNone) blocks_[other].near[26 - slot] = &fresh;
    }
  }
  last_coordinate_ = coordinate;
  last_ = &blocks_[number];
  return *last_;
}

SparseIndex::Block* SparseIndex::find(GridIndex coordinate) {
  if (last_ != nullptr && last_coordinate_ == coordinate) return last_;
  const std::int32_t number = table_.find(coordinate);
  if (number == kNone) return nullptr;
  last_coordinate_ = coordinate;
  last_ = &blocks_[number];
  return last_;
}

void SparseIndex::clear() {
  table_.clear();
  blocks_.clear();
  last_ = nullptr;
}

}  // namespace linescope
