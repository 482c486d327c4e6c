#include "viewer/surface/patch_map.hpp"

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

constexpr int kOwnColumn = 4;

// Lent curvature is right within this share of the curvature to expect.
constexpr double kLentShare = 0.25;

}  // namespace

PatchMap::PatchMap(const MesherOptions& options) {
  const double deviation = options.typical_deviation / options.interval;
  const double curvature = 0.5 * options.typical_curvature * options.interval;
  options_.fit = options.fit;
  options_.point_variance = deviation * deviation;
  curvature_variance_ = curvature * curvature;
  options_.min_points = options.min_points;
  options_.min_lines = options.min_lines;
}

void PatchMap::update(const MomentGrid& grid, PatchListener& listener) {
  while (records_.size() < grid.cell_count()) records_.add();
  runs_.begin_round(grid);
  affected_.clear();
  waiting_.clear();
  for (const std::int32_t cell : grid.changed()) runs_.cell(cell) = statistics_of(grid.cell(cell).content);
  const bool all = collect_affected(grid);
  for (const std::int32_t cell : affected_)
    for (int axis = 0; axis < 3; ++axis)
      if ((records_[cell].redo >> axis & 1) != 0) refit(grid, cell, axis, listener);
  solve_taken(grid, listener);
  if (!all) let_borrowers_wait(grid);
  for (const std::int32_t cell : affected_) records_[cell].redo = 0;
  for (const std::int32_t cell : waiting_) {
    for (int axis = 0; axis < 3; ++axis)
      if ((records_[cell].wait >> axis & 1) != 0) refit_at_border(grid, cell, axis, listener);
    records_[cell].wait = 0;
  }
  solve_taken(grid, listener);
}

// The candidate that was looked at last is to become a patch.
void PatchMap::take(const MomentGrid& grid, PatchListener& listener) {
  if (++taken_ == kPatchLanes) solve_taken(grid, listener);
}

void PatchMap::solve_taken(const MomentGrid& grid, PatchListener& listener) {
  if (taken_ == 0) return;
  FourPatches patches;
  for (std::size_t i = 0; i < kPatchLanes; ++i) patches[i] = candidates_[i < taken_ ? i : 0].fit.equations();
  const FourSolutions found = solve_patches(patches, options_.fit, unit_variance(options_));
  for (std::size_t i = 0; i < taken_; ++i)
    hold(grid, candidates_[i].cell, candidates_[i].fit.patch(found[i]), listener);
  taken_ = 0;
}

// What borders on a patch that was looked at borrows from it.
void PatchMap::let_borrowers_wait(const MomentGrid& grid) {
  for (const std::int32_t cell : affected_)
    for (const std::int32_t other : grid.cell(cell).near)
      if (other != kNone) let_wait(other, records_[other].border & records_[cell].redo);
}

// A patch depends on the stretches of cubes, in the nine columns around its cube, that begin next to it
// (column_of). The other way round: a changed cube affects all cubes next to it, and those farther along
// an axis only through cubes that lead there. In its own column it also decides who is the middle; in the
// others only middles care. Cubes emptied by an undo still lead, so nothing is missed.
bool PatchMap::collect_affected(const MomentGrid& grid) {
  for (const std::int32_t changed : grid.changed()) visit(changed, 0b111);
  if (affected_.size() == grid.cell_count()) return true;
  for (const std::int32_t changed : grid.changed())
    for (const std::int32_t other : grid.cell(changed).near)
      if (other != kNone) visit(other, 0b111);
  if (affected_.size() == grid.cell_count()) return true;
  for (const std::int32_t changed : grid.changed())
    for (int axis = 0; axis < 3; ++axis)
      for (const int direction : {-1, 1}) collect_along(grid, changed, axis, direction);
  return false;
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

void PatchMap::let_wait(std::int32_t cell, unsigned axes) {
  Record& record = records_[cell];
  if (axes == 0) return;
  if (record.wait == 0) waiting_.push_back(cell);
  record.wait = static_cast<std::uint8_t>(record.wait | axes);
}

void PatchMap::drop(const MomentGrid& grid, std::int32_t number, int axis, PatchListener& listener) {
  std::int32_t& held = records_[number].patch[static_cast<std::size_t>(axis)];
  if (held == kNone) return;
  listener.patch_removed(grid.cell(number), patches_[held]);
  unused_patches_.push_back(held);
  held = kNone;
}

void PatchMap::hold(const MomentGrid& grid, std::int32_t number, const std::optional<SurfacePatch>& patch,
                    PatchListener& listener) {
  if (!patch) return;
  std::int32_t& held = records_[number].patch[static_cast<std::size_t>(patch->axis)];
  held = free_patch();
  patches_[held] = *patch;
  listener.patch_added(grid.cell(number), *patch);
}

void PatchMap::refit(const MomentGrid& grid, std::int32_t number, int axis, PatchListener& listener) {
  drop(grid, number, axis, listener);
  Record& record = records_[number];
  const unsigned bit = 1u << axis;
  record.middle = static_cast<std::uint8_t>(record.middle & ~bit);
  record.border = static_cast<std::uint8_t>(record.border & ~bit);
  if (!runs_.occupied(number) || !is_middle_of_column(grid, number, axis)) return;
  record.middle = static_cast<std::uint8_t>(record.middle | bit);
  PatchFit& fit = look_at(grid, number, axis);
  if (!fit.possible()) return;
  if (fit.has_all_columns()) {
    fit.believe({{}, curvature_variance_});
    return take(grid, listener);
  }
  record.border = static_cast<std::uint8_t>(record.border | bit);
  let_wait(number, bit);
}

void PatchMap::refit_at_border(const MomentGrid& grid, std::int32_t number, int axis,
                               PatchListener& listener) {
  drop(grid, number, axis, listener);
  PatchFit& fit = look_at(grid, number, axis);
  if (!fit.possible()) return;
  fit.believe(lent_curvature(grid, number, axis));
  take(grid, listener);
}

// At a border the columns cannot tell slope from curvature: it is taken from the complete patches next to it.
CurvaturePrior PatchMap::lent_curvature(const MomentGrid& grid, std::int32_t number, int axis) const {
  CurvaturePrior prior{{}, curvature_variance_};
  double lenders = 0;
  for (const std::int32_t other : grid.cell(number).near) {
    if (other == kNone || (records_[other].border >> axis & 1) != 0) continue;
    const std::int32_t patch = records_[other].patch[static_cast<std::size_t>(axis)];
    if (patch == kNone) continue;
    for (std::size_t i = 0; i < 3; ++i) prior.mean[i] += patches_[patch].curvature[i];
    ++lenders;
  }
  if (lenders == 0) return prior;
  for (double& mean : prior.mean) mean /= lenders;
  prior.variance *= kLentShare * kLentShare;
  return prior;
}

std::int32_t PatchMap::free_patch() {
  if (unused_patches_.empty()) return patches_.add();
  const std::int32_t number = unused_patches_.back();
  unused_patches_.pop_back();
  return number;
}

bool PatchMap::is_middle_of_column(const MomentGrid& grid, std::int32_t number, int axis) {
  const ColumnRuns::Place place = runs_.find(grid, number, axis);
  return place.run != nullptr && place.run->middle == place.height;
}

// Of a column beside the middle cube the stretch of occupied cubes that begins at its height or one off.
PatchColumn PatchMap::column_of(const MomentGrid& grid, std::int32_t middle, int axis, int i,
                                ColumnRun& own) {
  for (const int height : {0, 1, -1}) {
    const std::int32_t seed = linked(grid.cell(middle), axis, i, height);
    if (seed == kNone || !runs_.occupied(seed)) continue;
    const ColumnRuns::Place place = runs_.find(grid, seed, axis);
    if (place.run == nullptr) return clipped_column(grid, seed, height, axis, own);
    const int base = height - place.height, top = base + place.run->stack.count - 1;
    if (base < -kPatchReach || top > kPatchReach) return clipped_column(grid, seed, height, axis, own);
    if (!place.run->merged) place.run->statistics = merged(place.run->stack, axis);
    place.run->merged = true;
    return {&place.run->stack, &place.run->statistics, base};
  }
  return {};
}

// The same of a stretch that is longer than the patch reaches.
PatchColumn PatchMap::clipped_column(const MomentGrid& grid, std::int32_t seed, int height, int axis,
                                     ColumnRun& own) {
  const auto next = [&](std::int32_t from, int direction) {
    const std::int32_t other = linked(grid.cell(from), axis, kOwnColumn, direction);
    return other != kNone && runs_.occupied(other) ? other : kNone;
  };
  std::int32_t at = seed;
  for (std::int32_t below = next(at, -1); below != kNone && height > -kPatchReach; below = next(at, -1)) {
    at = below;
    --height;
  }
  own.stack.count = 0;
  for (int h = height; at != kNone && h <= kPatchReach; at = next(at, 1), ++h) own.stack.add(&runs_.cell(at));
  own.statistics = merged(own.stack, axis);
  return {&own.stack, &own.statistics, height};
}

PatchFit& PatchMap::look_at(const MomentGrid& grid, std::int32_t number, int axis) {
  Candidate& next = candidates_[taken_];
  next.cell = number;
  next.input.axis = axis;
  for (int i = 0; i < 9; ++i) {
    const auto column = static_cast<std::size_t>(i);
    next.input.columns[column] = column_of(grid, number, axis, i, next.clipped[column]);
  }
  next.fit.begin(next.input, options_);
  return next.fit;
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
  runs_.clear();
  records_.clear();
  patches_.clear();
  unused_patches_.clear();
}

}  // namespace linescope
