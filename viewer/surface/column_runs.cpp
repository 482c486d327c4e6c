#include "viewer/surface/column_runs.hpp"

#include <algorithm>
#include <cmath>

namespace linescope {
namespace {

// Position of a covariance entry (i, j) in xx xy xz yy yz zz.
constexpr std::array<std::array<std::size_t, 3>, 3> kEntry{{{0, 1, 2}, {1, 3, 4}, {2, 4, 5}}};

// Neighbour slots one up along x, y, z.
constexpr std::array<std::size_t, 3> kUp{14, 16, 22};

// An axis and the entries of symmetric 3x3 sums as seen from it.
struct Axes {
  explicit Axes(int axis)
      : h(static_cast<std::size_t>(axis)),
        u((h + 1) % 3),
        v((h + 2) % 3),
        uu(kEntry[u][u]),
        uv(kEntry[u][v]),
        vv(kEntry[v][v]),
        uh(kEntry[u][h]),
        vh(kEntry[v][h]),
        hh(kEntry[h][h]) {}
  std::size_t h, u, v, uu, uv, vv, uh, vh, hh;
};

void add_points(ColumnStatistics& sums, const CellStatistics& s, const Axes& ax, double height) {
  const double u = s.mean[ax.u], v = s.mean[ax.v], h = s.mean[ax.h] + height, w = s.weight;
  sums.weight += w;
  sums.points += s.points;
  sums.u += w * u;
  sums.v += w * v;
  sums.h += w * h;
  sums.uu += w * (s.covariance[ax.uu] + u * u);
  sums.uv += w * (s.covariance[ax.uv] + u * v);
  sums.vv += w * (s.covariance[ax.vv] + v * v);
  sums.uh += w * (s.covariance[ax.uh] + u * h);
  sums.vh += w * (s.covariance[ax.vh] + v * h);
  sums.hh += w * (s.covariance[ax.hh] + h * h);
}

void add_lines(ColumnStatistics& sums, const CellStatistics& s, const Axes& ax, double height) {
  sums.most_lines = std::max(sums.most_lines, s.lines);
  sums.lines += s.lines;
  for (std::size_t i = 0; i < 3; ++i) sums.towards[i] += s.towards[i];
  sums.parts += s.parts;
  sums.parts_weight += s.parts_weight;
  sums.parts_u += s.parts_sum[ax.u];
  sums.parts_v += s.parts_sum[ax.v];
  sums.parts_h += s.parts_sum[ax.h] + height * s.parts_weight;
  sums.parts_uu += s.parts_squares[ax.uu];
  sums.parts_uv += s.parts_squares[ax.uv];
  sums.parts_vv += s.parts_squares[ax.vv];
  sums.parts_uh += s.parts_squares[ax.uh] + height * s.parts_sum[ax.u];
  sums.parts_vh += s.parts_squares[ax.vh] + height * s.parts_sum[ax.v];
  sums.parts_hh += s.parts_squares[ax.hh] + height * (2 * s.parts_sum[ax.h] + height * s.parts_weight);
}

void sums_to_means(ColumnStatistics& c) {
  if (c.weight == 0) return;
  const double inverse = 1.0 / c.weight;
  c.u *= inverse;
  c.v *= inverse;
  c.h *= inverse;
  c.uu = c.uu * inverse - c.u * c.u;
  c.uv = c.uv * inverse - c.u * c.v;
  c.vv = c.vv * inverse - c.v * c.v;
  c.uh = c.uh * inverse - c.u * c.h;
  c.vh = c.vh * inverse - c.v * c.h;
  c.hh = c.hh * inverse - c.h * c.h;
}

// The cube in which the mean height lies.
int middle_of(const CubeStack& stack, std::size_t axis) {
  double weight = 0, height = 0;
  for (int i = 0; i < stack.count; ++i) {
    const CellStatistics& s = *stack.cells[static_cast<std::size_t>(i)];
    weight += s.weight;
    height += s.weight * (s.mean[axis] + i);
  }
  return static_cast<int>(std::floor(height / weight));
}

}  // namespace

ColumnStatistics merged(const CubeStack& stack, int axis, unsigned excluded) {
  const Axes ax(axis);
  ColumnStatistics result;
  for (int i = 0; i < stack.count; ++i) {
    if ((excluded >> i & 1) != 0) continue;
    const CellStatistics& cell = *stack.cells[static_cast<std::size_t>(i)];
    add_points(result, cell, ax, i);
    add_lines(result, cell, ax, i);
  }
  sums_to_means(result);
  return result;
}

void ColumnRuns::begin_round(const MomentGrid& grid) {
  while (cells_.size() < grid.cell_count()) cells_.add();
  runs_.clear();
  ++round_;
}

ColumnRuns::Place ColumnRuns::find(const MomentGrid& grid, std::int32_t number, int axis) {
  const auto a = static_cast<std::size_t>(axis);
  const Cell& cell = cells_[number];
  if (cell.round[a] != round_) make_run(grid, number, axis);
  if (cell.run[a] == kTooLong) return {};
  return {&runs_[cell.run[a]], cell.height[a]};
}

std::int32_t ColumnRuns::next(const MomentGrid& grid, std::int32_t number, std::size_t slot) const {
  const std::int32_t other = grid.cell(number).near[slot];
  return other != SparseIndex::kNone && occupied(other) ? other : SparseIndex::kNone;
}

bool ColumnRuns::known_too_long(std::int32_t number, std::size_t axis) const {
  return cells_[number].round[axis] == round_ && cells_[number].run[axis] == kTooLong;
}

// A cube next to one whose run is too long is in the same run: of a long one each cube is looked at about
// once.
void ColumnRuns::make_run(const MomentGrid& grid, std::int32_t number, int axis) {
  const auto a = static_cast<std::size_t>(axis);
  std::array<std::int32_t, 2 * kLongest + 1> cells{};
  int low = kLongest, high = kLongest + 1;  // cells[low] to cells[high - 1]
  cells[kLongest] = number;
  bool too_long = false;
  for (std::int32_t at = number; !too_long && (at = next(grid, at, 26 - kUp[a])) != SparseIndex::kNone;) {
    cells[static_cast<std::size_t>(--low)] = at;
    too_long = high - low > kLongest || known_too_long(at, a);
  }
  for (std::int32_t at = number; !too_long && (at = next(grid, at, kUp[a])) != SparseIndex::kNone;) {
    cells[static_cast<std::size_t>(high++)] = at;
    too_long = high - low > kLongest || known_too_long(at, a);
  }
  if (!too_long) return make_run(cells.data() + low, high - low, axis);
  cells_[number].round[a] = round_;
  cells_[number].run[a] = kTooLong;
}

void ColumnRuns::make_run(const std::int32_t* cells, int count, int axis) {
  const auto a = static_cast<std::size_t>(axis);
  const std::int32_t run_number = runs_.add();
  most_runs_ = std::max(most_runs_, runs_.size());
  ColumnRun& run = runs_[run_number];
  for (int i = 0; i < count; ++i) {
    Cell& cell = cells_[cells[i]];
    cell.round[a] = round_;
    cell.run[a] = run_number;
    cell.height[a] = static_cast<std::int8_t>(i);
    run.stack.add(&cell.statistics);
  }
  const int middle = middle_of(run.stack, a);
  if (middle >= 0 && middle < kPatchReach && count - 1 - middle >= 0 && count - 1 - middle < kPatchReach)
    run.middle = middle;
}

}  // namespace linescope
