#include "viewer/surface/patch_map.hpp"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace linescope {
namespace {

constexpr double kMinAxisShare = 0.55;  // below 1/sqrt(3): at least one axis always passes

using Offset = std::array<int, 3>;

Offset offset_along(int axis, int u, int v, int h) {
  Offset offset{};
  offset[static_cast<std::size_t>((axis + 1) % 3)] = u;
  offset[static_cast<std::size_t>((axis + 2) % 3)] = v;
  offset[static_cast<std::size_t>(axis)] = h;
  return offset;
}

std::int32_t cell_at_offset(const MomentGrid& grid, const MomentCell& from, const Offset& d) {
  const std::int32_t number =
      grid.cell_near(from.block, (from.at.x & 7) + d[0], (from.at.y & 7) + d[1], (from.at.z & 7) + d[2]);
  if (number == BlockTable::kNone || !grid.cell(number).occupied()) return BlockTable::kNone;
  return number;
}

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
  ++round_;
  affected_.clear();
  for (const std::int32_t cell : grid.changed()) records_[cell].statistics = statistics_of(grid.cell(cell));
  collect_affected(grid);
  for (const std::int32_t cell : affected_) refit(grid, cell, listener);
}

// The axes of a cube depend on the 27 cubes around it; its patch along an axis on the columns next to it, up
// to kPatchReach cubes up and down. So do, the other way round, the cubes that a changed cube affects.
void PatchMap::collect_affected(const MomentGrid& grid) {
  for (const std::int32_t changed : grid.changed())
    for (int i = 0; i < 27; ++i) {
      const MomentCell& cell = grid.cell(changed);
      const std::int32_t other =
          i == 13 ? changed : cell_at_offset(grid, cell, {i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1});
      if (other == BlockTable::kNone || records_[other].round == round_) continue;
      visit(other);
      find_axes(grid, other);
    }
  for (const std::int32_t changed : grid.changed())
    for (int axis = 0; axis < 3; ++axis)
      for (int i = 0; i < 9; ++i)
        for (int h = 2; h <= kPatchReach; ++h)
          for (const int step : {-h, h}) {
            const Offset offset = offset_along(axis, i % 3 - 1, i / 3 - 1, step);
            const std::int32_t other = cell_at_offset(grid, grid.cell(changed), offset);
            if (other != BlockTable::kNone && (records_[other].axes >> axis & 1) != 0) visit(other);
          }
}

void PatchMap::visit(std::int32_t cell) {
  if (records_[cell].round == round_) return;
  records_[cell].round = round_;
  affected_.push_back(cell);
}

void PatchMap::find_axes(const MomentGrid& grid, std::int32_t number) {
  records_[number].axes = 0;
  if (!grid.cell(number).occupied()) return;
  double weight = 0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 27; ++i) {
    const Offset d{i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
    const std::int32_t other = i == 13 ? number : cell_at_offset(grid, grid.cell(number), d);
    if (other == BlockTable::kNone) continue;
    const CellStatistics& s = records_[other].statistics;
    const auto& c = s.covariance;
    const Eigen::Vector3d p(s.mean[0] + d[0], s.mean[1] + d[1], s.mean[2] + d[2]);
    weight += s.weight;
    mean += s.weight * p;
    second(0, 0) += s.weight * (c[0] + p.x() * p.x());
    second(1, 0) += s.weight * (c[1] + p.x() * p.y());
    second(2, 0) += s.weight * (c[2] + p.x() * p.z());
    second(1, 1) += s.weight * (c[3] + p.y() * p.y());
    second(2, 1) += s.weight * (c[4] + p.y() * p.z());
    second(2, 2) += s.weight * (c[5] + p.z() * p.z());
  }
  mean /= weight;
  second = second / weight - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(second);  // reads the lower half; eigenvalues ascend
  const Eigen::Vector3d normal = solver.eigenvectors().col(0);
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(normal[axis]) >= kMinAxisShare)
      records_[number].axes = static_cast<std::uint8_t>(records_[number].axes | 1 << axis);
}

void PatchMap::refit(const MomentGrid& grid, std::int32_t number, PatchListener& listener) {
  const MomentCell& cell = grid.cell(number);
  for (int axis = 0; axis < 3; ++axis) {
    auto& held = records_[number].patches[static_cast<std::size_t>(axis)];
    if (held) listener.patch_removed(cell, *held);
    held.reset();
    if (!cell.occupied() || (records_[number].axes >> axis & 1) == 0) continue;
    held = fit(grid, cell, axis);
    if (held) listener.patch_added(cell, *held);
  }
}

bool PatchMap::is_middle_of_column(const MomentGrid& grid, const MomentCell& cell, int axis) const {
  double weight = 0, height = 0;
  const auto a = static_cast<std::size_t>(axis);
  for (const int direction : {1, -1})
    for (int h = direction > 0 ? 0 : -1; std::abs(h) <= kPatchReach; h += direction) {
      const std::int32_t number = cell_at_offset(grid, cell, offset_along(axis, 0, 0, h));
      if (number == BlockTable::kNone) break;
      const CellStatistics& s = records_[number].statistics;
      weight += s.weight;
      height += s.weight * (s.mean[a] + h);
    }
  return height >= 0 && height < weight;
}

// Of the cubes of a neighbouring column the stretch nearest to the middle cube without a gap.
void PatchMap::gather_column(const MomentGrid& grid, const MomentCell& cell, int axis, int u, int v,
                             PatchColumn& column) const {
  std::array<std::int32_t, 2 * kPatchReach + 1> numbers{};
  for (int h = -kPatchReach; h <= kPatchReach; ++h)
    numbers[static_cast<std::size_t>(h + kPatchReach)] =
        cell_at_offset(grid, cell, offset_along(axis, u, v, h));
  const auto occupied = [&](int h) {
    return std::abs(h) <= kPatchReach &&
           numbers[static_cast<std::size_t>(h + kPatchReach)] != BlockTable::kNone;
  };
  int nearest = 0;
  for (int h = 1; h <= kPatchReach && !occupied(nearest); ++h) nearest = occupied(h) ? h : -h;
  if (!occupied(nearest)) return;
  int low = nearest, high = nearest;
  while (occupied(low - 1)) --low;
  while (occupied(high + 1)) ++high;
  for (int h = low; h <= high; ++h)
    column.add({&records_[numbers[static_cast<std::size_t>(h + kPatchReach)]].statistics,
                offset_along(axis, u, v, h)});
}

bool PatchMap::carries_surface(const MomentGrid& grid, std::int32_t number) const {
  for (int i = 0; i < 27; ++i) {
    const Offset d{i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
    const std::int32_t other = cell_at_offset(grid, grid.cell(number), d);
    if (other == BlockTable::kNone || static_cast<std::size_t>(other) >= records_.size()) continue;
    for (const auto& patch : records_[other].patches)
      if (patch) return true;
  }
  return false;
}

std::optional<SurfacePatch> PatchMap::fit(const MomentGrid& grid, const MomentCell& cell, int axis) {
  if (!is_middle_of_column(grid, cell, axis)) return std::nullopt;
  PatchInput input;
  input.axis = axis;
  for (int i = 0; i < 9; ++i)
    gather_column(grid, cell, axis, i % 3 - 1, i / 3 - 1, input.columns[static_cast<std::size_t>(i)]);
  return fit_patch(input, options_);
}

}  // namespace linescope
