#include "viewer/surface/moment_grid.hpp"

#include <algorithm>

namespace linescope {

MomentGrid::MomentGrid(double interval, std::size_t max_memory)
    : interval_(interval), max_memory_(max_memory) {}

void MomentGrid::begin_sweep() {
  ++sweep_;
  sweep_begins_.push_back({journal_.size(), filled_.size()});
}

std::uint64_t MomentGrid::add_line(const PlacedLine& line, const Eigen::Vector3d& seen_from) {
  ++line_;
  line_cells_.clear();
  std::uint64_t used = 0;
  for_each_tile(line.points, line.bounds, 0, [&](std::span<const PlacedBlock> part, const TileBox& box) {
    for (; !part.empty(); part = part.subspan(std::min(part.size(), MomentTile::kBatch)))
      for (const auto& [place, sums] : tile_.sums(part.first(std::min(part.size(), MomentTile::kBatch)), box))
        if (add_to_cell(line.corner + box.place(place), sums))
          used += static_cast<std::uint64_t>(sums.points());
  });
  const Eigen::Vector3d direction = towards_camera(seen_from);
  const Eigen::Vector3i towards = (256 * direction).cast<std::int32_t>();
  int axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  for (const LineCell& part : line_cells_) {
    auto& sum = cells_[part.cell].content.towards;
    for (std::size_t i = 0; i < 3; ++i) sum[i] += towards[static_cast<Eigen::Index>(i)];
    book_part(part, axis);
  }
  return used;
}

// A column's part is booked by its lowest cube in the line: it collects the cubes above it. (The camera looks
// along the columns of its dominant axis.)
void MomentGrid::book_part(const LineCell& lowest, int axis) {
  constexpr std::array<std::size_t, 3> kUp{14, 16, 22};  // neighbour slots one up along x, y, z
  const std::size_t up = kUp[static_cast<std::size_t>(axis)], down = 26 - up;
  const auto in_line = [this](std::int32_t number) {
    return number != SparseIndex::kNone && cells_[number].line == line_ ? &cells_[number] : nullptr;
  };
  if (in_line(cells_[lowest.cell].near[down]) != nullptr) return;
  std::array<std::int64_t, 4> part{};
  std::int64_t most = 0, height = 0, height_of_most = 0;
  MomentCell* holder = nullptr;
  for (MomentCell* cell = &cells_[lowest.cell]; cell != nullptr; cell = in_line(cell->near[up]), ++height) {
    const auto& first = line_cells_[static_cast<std::size_t>(cell->line_slot)].first;
    for (std::size_t i = 0; i < 4; ++i) part[i] += first[i];
    part[static_cast<std::size_t>(axis)] += first[3] * height * kSteps;
    if (first[3] <= most) continue;
    most = first[3];
    height_of_most = height;
    holder = cell;
  }
  part[static_cast<std::size_t>(axis)] -= part[3] * height_of_most * kSteps;
  holder->content.parts.add(part);
}

bool MomentGrid::add_to_cell(GridIndex at, const MomentSums& sums) {
  const std::int32_t number = cell_at(at);
  if (number == SparseIndex::kNone) return false;
  MomentCell& cell = cells_[number];
  if (cell.line != line_) begin_line_in(number);
  LineCell& part = line_cells_[static_cast<std::size_t>(cell.line_slot)];
  for (std::size_t i = 0; i < 4; ++i) part.first[i] += sums.first[i];
  cell.content.sums.add(sums);
  return true;
}

void MomentGrid::begin_line_in(std::int32_t number) {
  MomentCell& cell = cells_[number];
  if (cell.sweep != sweep_) {
    cell.sweep = sweep_;
    if (cell.occupied())
      journal_[journal_.add()] = {number, cell.content};
    else
      filled_.push_back(number);
  }
  if (!cell.occupied()) ++occupied_;
  ++cell.content.lines;
  cell.line = line_;
  cell.line_slot = static_cast<std::int32_t>(line_cells_.size());
  line_cells_.emplace_back().cell = number;  // in place: a copy waits for what was just written
  flag_changed(number);
}

// One direction for the whole line, from the middle of its cubes: it only has to tell one side from the
// other.
Eigen::Vector3d MomentGrid::towards_camera(const Eigen::Vector3d& seen_from) const {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const LineCell& part : line_cells_) {
    const GridIndex at = cells_[part.cell].at;
    middle += Eigen::Vector3d(at.x, at.y, at.z);
  }
  middle = (middle / std::max(1.0, static_cast<double>(line_cells_.size()))).array() + 0.5;
  return (seen_from / interval_ - middle).normalized();
}

void MomentGrid::flag_changed(std::int32_t number) {
  if (cells_[number].changed) return;
  cells_[number].changed = true;
  changed_.push_back(number);
}

void MomentGrid::forget_changes() {
  for (const std::int32_t number : changed_) cells_[number].changed = false;
  changed_.clear();
}

std::int64_t MomentGrid::remove_last_sweep() {
  if (sweep_begins_.empty()) return -1;
  const auto [journal, filled] = sweep_begins_.back();
  std::int64_t removed = 0;
  for (std::size_t i = journal; i < journal_.size(); ++i) {
    const auto& [number, before] = journal_[static_cast<std::int32_t>(i)];
    removed += put_back(number, before);
  }
  for (std::size_t i = filled; i < filled_.size(); ++i) removed += put_back(filled_[i], {});
  journal_.shrink(journal);
  filled_.resize(filled);
  sweep_begins_.pop_back();
  return removed;
}

// How many points that takes out.
std::int64_t MomentGrid::put_back(std::int32_t number, const CellContent& before) {
  CellContent& now = cells_[number].content;
  const std::int64_t removed = now.sums.points() - before.sums.points();
  if (now.occupied() && !before.occupied()) --occupied_;
  now = before;
  flag_changed(number);
  return removed;
}

void MomentGrid::clear() {
  index_.clear();
  cells_.clear();
  changed_.clear();
  journal_.clear();
  filled_.clear();
  sweep_begins_.clear();
  occupied_ = 0;
}

std::int32_t MomentGrid::cell_at(GridIndex at) {
  const auto local = static_cast<std::size_t>(local_of(at));
  SparseIndex::Block* block = index_.find(block_of(at));
  if (block != nullptr && block->number[local] != SparseIndex::kNone) return block->number[local];
  if (memory_bytes() > max_memory_) return SparseIndex::kNone;
  if (block == nullptr) block = &index_.block(block_of(at));
  const std::int32_t number = cells_.add();
  block->number[local] = number;
  cells_[number].at = at;
  link(*block, number);
  return number;
}

void MomentGrid::link(const SparseIndex::Block& block, std::int32_t number) {
  MomentCell& cell = cells_[number];
  SparseIndex::numbers_around(block, cell.at, cell.near);
  for (std::size_t slot = 0; slot < 27; ++slot)
    if (cell.near[slot] != SparseIndex::kNone) cells_[cell.near[slot]].near[26 - slot] = number;
}

std::size_t MomentGrid::memory_bytes() const {
  return index_.memory_bytes() + cells_.size() * sizeof(MomentCell) + journal_.size() * sizeof(CellBefore) +
         filled_.size() * sizeof(std::int32_t);
}

}  // namespace linescope
