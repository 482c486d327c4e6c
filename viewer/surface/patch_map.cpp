#include "viewer/surface/patch_map.hpp"

#include <cmath>
#include <cstdlib>

namespace linescope {
namespace {

// Neighbour slots of the nine columns around a cube along an axis: [axis][column][height + 1]; 4 is the own
// column.
using ColumnSlots = std::array<std::array<std::array<std::uint8_t, 3>, 9>, 3>;

std::array<int, 3> offset_along(int axis, int column, int height) {
  std::array<int, 3> offset{};
  offset[static_cast<std::size_t>((axis + 1) % 3)] = column % 3 - 1;
  offset[static_cast<std::size_t>((axis + 2) % 3)] = column / 3 - 1;
  offset[static_cast<std::size_t>(axis)] = height;
  return offset;
}

ColumnSlots all_slots() {
  ColumnSlots slots{};
  for (int axis = 0; axis < 3; ++axis)
    for (int column = 0; column < 9; ++column)
      for (int height = -1; height <= 1; ++height) {
        const auto d = offset_along(axis, column, height);
        slots[static_cast<std::size_t>(axis)][static_cast<std::size_t>(column)]
             [static_cast<std::size_t>(height + 1)] =
                 static_cast<std::uint8_t>(neighbour_slot(d[0], d[1], d[2]));
      }
  return slots;
}
const ColumnSlots kSlots = all_slots();

std::int32_t linked(const MomentCell& from, int axis, int column, int height) {
  const auto& slots = kSlots[static_cast<std::size_t>(axis)][static_cast<std::size_t>(column)];
  return from.near[slots[static_cast<std::size_t>(height + 1)]];
}

// The same, if it holds points.
std::int32_t occupied_near(const MomentGrid& grid, const MomentCell& from, int axis, int column, int height) {
  const std::int32_t number = linked(from, axis, column, height);
  return number != SparseIndex::kNone && grid.cell(number).occupied() ? number : SparseIndex::kNone;
}

constexpr int kOwnColumn = 4;

}  // namespace

PatchMap::PatchMap(const MesherOptions& options) {
  const double deviation = options.typical_deviation / options.interval;
  const double curvature = 0.5 * options.typical_curvature * options.interval;
  options_.fit = options.fit;
  options_.point_variance = deviation * deviation;
  options_.curvature_variance = curvature * curvature;
  options_.min_points = options.min_points;
  options_.min_lines = options.min_lines;
}

void PatchMap::update(const MomentGrid& grid, PatchListener& listener) {
  while (records_.size() < grid.cell_count()) records_.add();
  affected_.clear();
  for (const std::int32_t cell : grid.changed())
    records_[cell].statistics = statistics_of(grid.cell(cell).content);
  collect_affected(grid);
  for (const std::int32_t cell : affected_) {
    for (int axis = 0; axis < 3; ++axis)
      if ((records_[cell].redo >> axis & 1) != 0) refit(grid, cell, axis, listener);
    records_[cell].redo = 0;
  }
}

// A patch depends on the stretches of cubes, in the nine columns around its cube, that begin next to it
// (gather_column). The other way round: a changed cube affects all cubes next to it, and those farther along
// an axis only through cubes that lead there. In its own column it also decides who is the middle; in the
// others only middles care. Cubes emptied by an undo still lead, so nothing is missed.
void PatchMap::collect_affected(const MomentGrid& grid) {
  for (const std::int32_t changed : grid.changed())
    for (const std::int32_t other : grid.cell(changed).near)
      if (other != kNone) visit(other, 0b111);
  if (affected_.size() == grid.cell_count()) return;
  for (const std::int32_t changed : grid.changed())
    for (int axis = 0; axis < 3; ++axis)
      for (const int direction : {-1, 1}) collect_along(grid, changed, axis, direction);
}

void PatchMap::collect_along(const MomentGrid& grid, std::int32_t from, int axis, int direction) {
  for (int h = 1; h < kPatchReach; ++h) {
    from = linked(grid.cell(from), axis, kOwnColumn, direction);
    if (from == kNone) return;
    for (int column = 0; column < 9; ++column) {
      const std::int32_t other = linked(grid.cell(from), axis, column, direction);
      if (other == kNone) continue;
      if (column == kOwnColumn || (records_[other].middle >> axis & 1) != 0) visit(other, 1u << axis);
    }
  }
}

void PatchMap::visit(std::int32_t cell, unsigned axes) {
  Record& record = records_[cell];
  if (record.redo == 0) affected_.push_back(cell);
  record.redo = static_cast<std::uint8_t>(record.redo | axes);
}

void PatchMap::refit(const MomentGrid& grid, std::int32_t number, int axis, PatchListener& listener) {
  Record& record = records_[number];
  std::int32_t& held = record.patch[static_cast<std::size_t>(axis)];
  if (held != kNone) {
    listener.patch_removed(grid.cell(number), patches_[held]);
    unused_patches_.push_back(held);
    held = kNone;
  }
  const bool middle = grid.cell(number).occupied() && is_middle_of_column(grid, number, axis);
  record.middle = static_cast<std::uint8_t>((record.middle & ~(1u << axis)) | (middle ? 1u : 0u) << axis);
  if (!middle) return;
  const auto found = fit(grid, number, axis);
  if (!found) return;
  held = free_patch();
  patches_[held] = *found;
  listener.patch_added(grid.cell(number), *found);
}

std::int32_t PatchMap::free_patch() {
  if (unused_patches_.empty()) return patches_.add();
  const std::int32_t number = unused_patches_.back();
  unused_patches_.pop_back();
  return number;
}

// The cube in which the mean of its stretch of occupied cubes lies. A stretch as long as the reach is no
// height: the surface runs along the axis there.
bool PatchMap::is_middle_of_column(const MomentGrid& grid, std::int32_t number, int axis) const {
  const auto a = static_cast<std::size_t>(axis);
  double weight = records_[number].statistics.weight, height = weight * records_[number].statistics.mean[a];
  for (const int direction : {-1, 1}) {
    std::int32_t at = number;
    for (int h = direction;; h += direction) {
      at = occupied_near(grid, grid.cell(at), axis, kOwnColumn, direction);
      if (at == kNone) break;
      if (std::abs(h) == kPatchReach) return false;
      const CellStatistics& s = records_[at].statistics;
      weight += s.weight;
      height += s.weight * (s.mean[a] + h);
    }
  }
  return height >= 0 && height < weight;
}

// Of a column beside the middle cube the stretch of occupied cubes that begins at its height or one off.
void PatchMap::gather_column(const MomentGrid& grid, std::int32_t middle, int axis, int i,
                             PatchColumn& column) const {
  std::int32_t seed = kNone;
  int height = 0;
  for (const int h : {0, 1, -1}) {
    if (seed != kNone) break;
    seed = occupied_near(grid, grid.cell(middle), axis, i, h);
    height = h;
  }
  if (seed == kNone) return;
  column.add({&records_[seed].statistics, offset_along(axis, i, height)});
  for (const int direction : {-1, 1}) {
    std::int32_t at = seed;
    for (int h = height + direction; std::abs(h) <= kPatchReach; h += direction) {
      at = occupied_near(grid, grid.cell(at), axis, kOwnColumn, direction);
      if (at == kNone) break;
      column.add({&records_[at].statistics, offset_along(axis, i, h)});
    }
  }
}

std::optional<SurfacePatch> PatchMap::fit(const MomentGrid& grid, std::int32_t number, int axis) const {
  PatchInput input;
  input.axis = axis;
  for (int i = 0; i < 9; ++i)
    gather_column(grid, number, axis, i, input.columns[static_cast<std::size_t>(i)]);
  return fit_patch(input, options_);
}

bool PatchMap::carries_surface(const MomentGrid& grid, std::int32_t number) const {
  for (const std::int32_t other : grid.cell(number).near) {
    if (other == kNone || static_cast<std::size_t>(other) >= records_.size()) continue;
    for (const std::int32_t patch : records_[other].patch)
      if (patch != kNone) return true;
  }
  return false;
}

void PatchMap::clear() {
  records_.clear();
  patches_.clear();
  unused_patches_.clear();
}

}  // namespace linescope
