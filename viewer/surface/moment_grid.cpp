#include "viewer/surface/moment_grid.hpp"

#include <algorithm>
#include <cmath>

#include "viewer/surface/point_gate.hpp"

namespace linescope {
namespace {

constexpr double kReach = 1 << 18;  // intervals; keeps a point's steps within 31 bits

// A line's points are numbered from a corner below all that the gate admits, so that offsets are positive and
// small enough for single precision to keep a sixteenth of a step.
struct LineOrigin {
  LineOrigin(const SurfaceLine& line, double max_distance, double interval) {
    const Eigen::Array3d lowest = ((line.seen_from.array() - max_distance) / interval).floor() - 1;
    const Eigen::Array3d clamped = lowest.max(-1.0 * kGridLimit).min(1.0 * kGridLimit);
    corner = clamped.cast<std::int32_t>();
    position = (clamped * interval).cast<float>();
  }
  Eigen::Array3i corner;
  Eigen::Array3f position;  // mm
};

// Rounds 4 (typical / sd)^2 to 1 .. 16; a deviation of 0 is unknown and counts as typical.
int weight_of(float deviation, float scale) {
  if (deviation == 0) return kTypicalWeight;
  const float exact = scale / (deviation * deviation) + 0.5f;
  return exact >= 16.0f ? 16 : std::max(1, static_cast<int>(exact));
}

void add_point(MomentSums& sums, std::int32_t x, std::int32_t y, std::int32_t z, std::int32_t w) {
  const std::int32_t wx = w * x, wy = w * y, wz = w * z;
  sums.w += w;
  sums.x += wx;
  sums.y += wy;
  sums.z += wz;
  sums.xx += wx * x;
  sums.xy += wx * y;
  sums.xz += wx * z;
  sums.yy += wy * y;
  sums.yz += wy * z;
  sums.zz += wz * z;
  ++sums.points;
}

}  // namespace

MomentGrid::MomentGrid(const MesherOptions& options)
    : interval_(options.interval),
      max_distance_(std::min(options.max_distance, kReach * options.interval)),
      weight_scale_(
          static_cast<float>(kTypicalWeight * options.typical_deviation * options.typical_deviation)),
      max_memory_(options.max_memory),
      options_(options) {
  options_.max_distance = max_distance_;
}

void MomentGrid::begin_sweep() {
  ++sweep_;
  journal_.emplace_back();
}

bool MomentGrid::add_line(const SurfaceLine& line, MesherCounters& counters) {
  const PointGate gate(options_, line);
  const LineOrigin origin(line, max_distance_, interval_);
  const float scale = static_cast<float>(kSteps / interval_);
  ++line_;
  line_cells_.clear();
  GridIndex current{INT32_MIN, 0, 0};
  LineCell* part = nullptr;
  std::uint64_t used = 0;
  for (const SurfacePoint& point : line.points) {
    if (!gate.admits(point)) {
      gate.count_refusal(point, counters);
      continue;
    }
    const Eigen::Array3f steps = (point.position.array() - origin.position) * scale;
    const std::int32_t x = static_cast<std::int32_t>(steps.x()), y = static_cast<std::int32_t>(steps.y()),
                       z = static_cast<std::int32_t>(steps.z());
    const GridIndex at{x >> kStepBits, y >> kStepBits, z >> kStepBits};
    if (!(at == current)) {
      current = at;
      part = line_cell({at.x + origin.corner.x(), at.y + origin.corner.y(), at.z + origin.corner.z()});
    }
    if (part == nullptr) {
      ++counters.no_room;
      continue;
    }
    add_point(part->sums, x & (kSteps - 1), y & (kSteps - 1), z & (kSteps - 1),
              weight_of(point.standard_deviation, weight_scale_));
    ++used;
  }
  counters.points += used;
  merge_line(line);
  return used != 0;
}

MomentGrid::LineCell* MomentGrid::line_cell(GridIndex at) {
  const std::int32_t number = cell_at(at);
  if (number == BlockTable::kNone) return nullptr;
  MomentCell& cell = cells_[number];
  if (cell.line != line_) {
    cell.line = line_;
    cell.line_slot = static_cast<std::int32_t>(line_cells_.size());
    line_cells_.push_back({number, {}});
  }
  return &line_cells_[static_cast<std::size_t>(cell.line_slot)];
}

void MomentGrid::merge_line(const SurfaceLine& line) {
  const Eigen::Vector3d camera = line.seen_from / interval_;
  for (const LineCell& part : line_cells_) merge(part, camera);
}

void MomentGrid::merge(const LineCell& part, const Eigen::Vector3d& camera) {
  MomentCell& cell = cells_[part.cell];
  if (cell.sweep != sweep_) {
    journal_.back().emplace_back(part.cell, cell);
    journal_bytes_ += sizeof(journal_.back().front());
    cell.sweep = sweep_;
  }
  if (!cell.occupied()) ++occupied_;
  cell.sums.add(part.sums);
  ++cell.lines;
  const std::array<double, 3> first{static_cast<double>(part.sums.x), static_cast<double>(part.sums.y),
                                    static_cast<double>(part.sums.z)};
  const double inverse = 1.0 / static_cast<double>(part.sums.w);
  for (std::size_t i = 0, k = 0; i < 3; ++i)
    for (std::size_t j = i; j < 3; ++j, ++k)
      cell.lines_apart[k] += static_cast<std::int64_t>(first[i] * first[j] * inverse + 0.5);
  const Eigen::Vector3d centre(cell.at.x + 0.5, cell.at.y + 0.5, cell.at.z + 0.5);
  const Eigen::Vector3d towards = (camera - centre).stableNormalized() * 256;
  for (int i = 0; i < 3; ++i)
    cell.towards[static_cast<std::size_t>(i)] += static_cast<std::int32_t>(towards[i]);
  flag_changed(part.cell);
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
  if (journal_.empty()) return -1;
  std::int64_t removed = 0;
  for (auto& [number, before] : journal_.back()) {
    MomentCell& cell = cells_[number];
    removed += cell.sums.points - before.sums.points;
    if (!before.occupied()) --occupied_;
    before.changed = cell.changed;
    before.line = cell.line;
    cell = before;
    flag_changed(number);
  }
  journal_bytes_ -= journal_.back().size() * sizeof(journal_.back().front());
  journal_.pop_back();
  return removed;
}

void MomentGrid::clear() {
  table_.clear();
  cells_.clear();
  changed_.clear();
  journal_.clear();
  occupied_ = journal_bytes_ = 0;
  last_block_ = BlockTable::kNone;
}

std::int32_t MomentGrid::cell_at(GridIndex at) {
  const GridIndex coordinate = block_of(at);
  if (last_block_ == BlockTable::kNone || !(coordinate == last_coordinate_)) {
    last_block_ = block_at(coordinate);
    last_coordinate_ = coordinate;
    if (last_block_ == BlockTable::kNone) return last_block_;
  }
  std::int32_t& number =
      blocks_[static_cast<std::size_t>(last_block_)][static_cast<std::size_t>(local_of(at))];
  if (number != BlockTable::kNone) return number;
  if (memory_bytes() > max_memory_) return BlockTable::kNone;
  number = cells_.add();
  cells_[number].at = at;
  cells_[number].block = last_block_;
  return number;
}

std::int32_t MomentGrid::block_at(GridIndex coordinate) {
  const std::int32_t known = table_.find(coordinate);
  if (known != BlockTable::kNone) return known;
  if (memory_bytes() > max_memory_) return BlockTable::kNone;
  bool added = false;
  const std::int32_t number = table_.find_or_add(coordinate, added);
  if (blocks_.size() < table_.size()) blocks_.emplace_back();
  blocks_[static_cast<std::size_t>(number)].fill(BlockTable::kNone);
  return number;
}

std::size_t MomentGrid::memory_bytes() const {
  return table_.memory_bytes() + table_.size() * sizeof(CellBlock) + cells_.size() * sizeof(MomentCell) +
         journal_bytes_;
}

}  // namespace linescope
