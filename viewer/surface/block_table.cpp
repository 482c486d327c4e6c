#include "viewer/surface/block_table.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace linescope {

std::uint64_t BlockTable::key_of(GridIndex block) {
  constexpr std::int32_t offset = 1 << 20;
  const auto part = [](std::int32_t v) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(v + offset));
  };
  return part(block.x) | part(block.y) << 21 | part(block.z) << 42;
}

std::size_t BlockTable::slot_of(std::uint64_t key) const {
  const std::uint64_t mixed = (key ^ key >> 29) * 0x9E3779B97F4A7C15ull;
  std::size_t at = static_cast<std::size_t>(mixed >> 20) & (slots_.size() - 1);
  while (slots_[at].number != kNone && slots_[at].key != key) at = (at + 1) & (slots_.size() - 1);
  return at;
}

std::int32_t BlockTable::find(GridIndex block) const {
  return slots_.empty() ? kNone : slots_[slot_of(key_of(block))].number;
}

std::int32_t BlockTable::find_or_add(GridIndex block, bool& added) {
  if (2 * (coordinates_.size() + 1) > slots_.size()) grow();
  Slot& slot = slots_[slot_of(key_of(block))];
  added = slot.number == kNone;
  if (!added) return slot.number;
  slot = {key_of(block), static_cast<std::int32_t>(coordinates_.size())};
  const std::int32_t number = slot.number;
  coordinates_.push_back(block);
  neighbours_.emplace_back();
  link(number);
  return number;
}

void BlockTable::grow() {
  slots_.assign(std::max<std::size_t>(64, 2 * slots_.size()), {});
  for (std::size_t i = 0; i < coordinates_.size(); ++i) {
    const std::uint64_t key = key_of(coordinates_[i]);
    slots_[slot_of(key)] = {key, static_cast<std::int32_t>(i)};
  }
}

void BlockTable::link(std::int32_t number) {
  const GridIndex own = coordinate(number);
  Neighbours& mine = neighbours_[static_cast<std::size_t>(number)];
  for (int dz = -1; dz <= 1; ++dz)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const std::int32_t other = find(own + GridIndex{dx, dy, dz});
        mine[static_cast<std::size_t>(neighbour_slot(dx, dy, dz))] = other;
        if (other != kNone)
          neighbours_[static_cast<std::size_t>(other)]
                     [static_cast<std::size_t>(neighbour_slot(-dx, -dy, -dz))] = number;
      }
}

const std::vector<std::int32_t>& BlockTable::ordered() {
  if (ordered_.size() == coordinates_.size()) return ordered_;
  ordered_.resize(coordinates_.size());
  std::iota(ordered_.begin(), ordered_.end(), 0);
  std::sort(ordered_.begin(), ordered_.end(), [this](std::int32_t a, std::int32_t b) {
    const GridIndex p = coordinate(a), q = coordinate(b);
    return std::tie(p.z, p.y, p.x) < std::tie(q.z, q.y, q.x);
  });
  return ordered_;
}

void BlockTable::clear() {
  std::fill(slots_.begin(), slots_.end(), Slot{});
  coordinates_.clear();
  neighbours_.clear();
  ordered_.clear();
}

std::size_t BlockTable::memory_bytes() const {
  return slots_.capacity() * sizeof(Slot) + coordinates_.capacity() * sizeof(GridIndex) +
         neighbours_.capacity() * sizeof(Neighbours) + ordered_.capacity() * sizeof(std::int32_t);
}

}  // namespace linescope
