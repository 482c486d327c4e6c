#include "viewer/surface/vertex_grid.hpp"

namespace linescope {

void VertexGrid::begin_sweep() {
  ++sweep_;
  journal_.emplace_back();
}

bool VertexGrid::add(GridIndex vertex, std::uint32_t points) {
  const GridIndex coordinate = block_of(vertex);
  if (last_block_ == BlockTable::kNone || !(coordinate == last_coordinate_)) {
    last_block_ = block_at(coordinate);
    last_coordinate_ = coordinate;
    if (last_block_ == BlockTable::kNone) return false;
  }
  const int local = local_of(vertex);
  VertexBlock& block = blocks_[static_cast<std::size_t>(last_block_)];
  std::uint32_t& count = block.count[static_cast<std::size_t>(local)];
  if (count == 0 && !reserve_lower_blocks(vertex)) return false;
  if (block.sweep[static_cast<std::size_t>(local)] != sweep_) {
    block.sweep[static_cast<std::size_t>(local)] = sweep_;
    journal_.back().push_back({last_block_, local, count});
    journal_bytes_ += sizeof(Change);
  }
  set_count(last_block_, local, count + points);
  return true;
}

std::int64_t VertexGrid::remove_last_sweep() {
  if (journal_.empty()) return -1;
  std::int64_t removed = 0;
  for (const Change& change : journal_.back()) {
    removed += block(change.block).count[static_cast<std::size_t>(change.local)] - change.count_before;
    set_count(change.block, change.local, change.count_before);
  }
  journal_bytes_ -= journal_.back().size() * sizeof(Change);
  journal_.pop_back();
  return removed;
}

void VertexGrid::clear() {
  table_.clear();
  journal_.clear();
  changed_.clear();
  marked_ = journal_bytes_ = 0;
  last_block_ = BlockTable::kNone;
}

void VertexGrid::forget_changes() {
  for (const std::int32_t number : changed_) block(number).changed = false;
  changed_.clear();
}

std::uint32_t VertexGrid::count_near(std::int32_t number, int x, int y, int z) const {
  const int slot = neighbour_slot(x >> kBlockBits, y >> kBlockBits, z >> kBlockBits);
  const std::int32_t at = table_.neighbours(number)[static_cast<std::size_t>(slot)];
  return at == BlockTable::kNone ? 0 : block(at).count[static_cast<std::size_t>(local_of({x, y, z}))];
}

std::size_t VertexGrid::memory_bytes() const {
  return table_.memory_bytes() + table_.size() * sizeof(VertexBlock) + journal_bytes_;
}

std::int32_t VertexGrid::block_at(GridIndex coordinate) {
  const std::int32_t known = table_.find(coordinate);
  if (known != BlockTable::kNone) return known;
  if (!has_room()) return BlockTable::kNone;
  bool added = false;
  const std::int32_t number = table_.find_or_add(coordinate, added);
  if (blocks_.size() < table_.size())
    blocks_.emplace_back();
  else
    block(number) = VertexBlock{};
  return number;
}

// A marked vertex is a corner of eight cubes; each belongs to the block of its lowest corner, which must be
// there.
bool VertexGrid::reserve_lower_blocks(GridIndex vertex) {
  if ((vertex.x & 7) != 0 && (vertex.y & 7) != 0 && (vertex.z & 7) != 0) return true;
  for (int corner = 1; corner < 8; ++corner) {
    const GridIndex low{vertex.x - (corner & 1), vertex.y - (corner >> 1 & 1), vertex.z - (corner >> 2)};
    if (block_at(block_of(low)) == BlockTable::kNone) return false;
  }
  return true;
}

bool VertexGrid::has_room() const {
  return memory_bytes() + sizeof(VertexBlock) <= max_memory_;
}

void VertexGrid::set_count(std::int32_t number, int local, std::uint32_t count) {
  VertexBlock& at = block(number);
  std::uint32_t& held = at.count[static_cast<std::size_t>(local)];
  const bool was_inside = held > isovalue_, is_inside = count > isovalue_;
  if (held == 0 && count != 0) ++marked_;
  if (held != 0 && count == 0) --marked_;
  held = count;
  if (was_inside == is_inside) return;
  at.inside[static_cast<std::size_t>(local >> 3)] ^= static_cast<std::uint8_t>(1 << (local & 7));
  flag_changed(number, local);
}

void VertexGrid::flag_changed(std::int32_t number, int local) {
  const int x = (local & 7) == 0 ? -1 : 0, y = (local >> 3 & 7) == 0 ? -1 : 0, z = (local >> 6) == 0 ? -1 : 0;
  for (int dz = z; dz <= 0; ++dz)
    for (int dy = y; dy <= 0; ++dy)
      for (int dx = x; dx <= 0; ++dx) {
        const std::int32_t lower =
            table_.neighbours(number)[static_cast<std::size_t>(neighbour_slot(dx, dy, dz))];
        if (lower == BlockTable::kNone || block(lower).changed) continue;
        block(lower).changed = true;
        changed_.push_back(lower);
      }
}

}  // namespace linescope
