#include "viewer/navigate/line_groups.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <span>

namespace linescope {
namespace {

/// A segment moved along its line's view onto the robust quadric, and how far it was off.
struct Placed {
  Eigen::Vector2d at;
  Eigen::Vector2d spread;
  double error;
};

/// Mean over a segment of the ten features, exact for points spread evenly about the mean along a straight
/// piece.
FitRow features_of(const Placed& p) {
  const double x = p.at.x(), y = p.at.y(), a = p.spread.x(), b = p.spread.y();
  FitRow row;
  row << 1, x, y, x * x + a * a, x * y + a * b, y * y + b * b, x * (x * x + 3 * a * a),
      x * (x * y + 2 * a * b) + y * a * a, y * (x * y + 2 * a * b) + x * b * b, y * (y * y + 3 * b * b), 0, 0;
  return row;
}

/// Of the quadric over a segment, by the first six features.
double mean_height(const Placed& p, const Quadric& quadric) {
  const double x = p.at.x(), y = p.at.y(), a = p.spread.x(), b = p.spread.y();
  const auto& q = quadric.b;
  return q[0] + q[1] * x + q[2] * y + q[3] * (x * x + a * a) + q[4] * (x * y + a * b) +
         q[5] * (y * y + b * b);
}

/// A segment that counts.
struct Used {
  Placed place;
  double weight;
  std::uint16_t line;
};

Placed placed(const Patch& patch, const Quadric& quadric, std::size_t i) {
  Placed p;
  p.at = {static_cast<double>(patch.x[i]), static_cast<double>(patch.y[i])};
  p.spread = {static_cast<double>(patch.sx[i]), static_cast<double>(patch.sy[i])};
  p.error = static_cast<double>(patch.z[i]) - mean_height(p, quadric);
  p.at -= p.error * patch.lines[patch.line[i]].shear.cast<double>();
  return p;
}

/// The segment on the straight line through `anchor` along `direction`. A line on a curved surface seen
/// askew is bent; its bend would be read as information about slope and curvature across the line, which it
/// is not. What the bend does to the height is taken from the quadric.
FitRow row_of(const Placed& p, const Quadric& quadric, const Eigen::Vector2d& anchor,
              const Eigen::Vector2d& direction) {
  const Placed straight{anchor + direction.dot(p.at - anchor) * direction,
                        direction.dot(p.spread) * direction, p.error};
  FitRow row = features_of(straight);
  row[10] = row.head<6>().dot(quadric.b) + p.error;
  return row;
}

/// Weighted sums of one line.
struct LineSums {
  double weight;
  Eigen::Vector2d anchor;  ///< weighted sum of the places; divided by the weight, their mean
  double along;
  double along_squared;
  FitRow rows;
  FitRow rows_along;
  int segments;

  void clear() {
    weight = along = along_squared = 0;
    anchor.setZero();
    rows.setZero();
    rows_along.setZero();
    segments = 0;
  }
  void anchor_at(const Eigen::Vector2d& at, double w) {
    weight += w;
    anchor += w * at;
  }
  void add(const FitRow& row, double w, double s) {
    along += w * s;
    along_squared += w * s * s;
    rows += w * row;
    rows_along += (w * s) * row;
    ++segments;
  }
  double spread() const { return along_squared - along * along / weight; }
};

/// Rows collected and summed many at a time; without the first three features, of which a straight line less
/// its offset and its slope has none.
class RowBatch {
 public:
  explicit RowBatch(RowSums& sums) : sums_(sums) {}
  void add(const FitRow& row, double weight) {
    rows_[size_] = row;
    weights_[size_] = weight;
    if (++size_ == rows_.size()) flush();
  }
  void flush() {
    add_curved_rows(rows_.data(), weights_.data(), size_, sums_);
    size_ = 0;
  }

 private:
  RowSums& sums_;
  std::array<FitRow, 64> rows_;
  std::array<double, 64> weights_;
  std::size_t size_ = 0;
};

/// Places of a patch's lines, by time.
void sort_by_time(const Patch& patch, std::span<std::uint16_t> order) {
  for (std::size_t l = 0; l < order.size(); ++l) order[l] = static_cast<std::uint16_t>(l);
  std::sort(order.begin(), order.end(), [&](std::uint16_t a, std::uint16_t b) {
    const PatchLine &p = patch.lines[a], &q = patch.lines[b];
    return p.time < q.time || (p.time == q.time && p.place < q.place);
  });
}

/// Direction of a line, from it and its neighbours in time: a hand does not turn between two frames, so what
/// differs between neighbours is noise, and would be read as information about the slope across the lines.
Eigen::Vector2d smoothed_direction(const Patch& patch, std::span<const std::uint16_t> order, std::size_t i) {
  constexpr std::size_t kNeighbours = 6;
  constexpr Nanoseconds kApart = 300 * kMillisecond;
  const PatchLine& line = patch.lines[order[i]];
  Eigen::Vector2f sum = Eigen::Vector2f::Zero();
  const std::size_t first = i > kNeighbours ? i - kNeighbours : 0;
  for (std::size_t k = first; k < std::min(order.size(), i + kNeighbours + 1); ++k) {
    const PatchLine& other = patch.lines[order[k]];
    if (std::abs(other.time - line.time) > kApart) continue;
    sum += other.direction.dot(line.direction) < 0 ? Eigen::Vector2f(-other.direction) : other.direction;
  }
  return sum.cast<double>().normalized();
}

}  // namespace

LineGroups::LineGroups(const Patch& patch, const Quadric& quadric, double segment_floor) {
  const auto line_count = static_cast<std::size_t>(patch.line_count);
  std::array<std::uint16_t, Patch::kMostLines> order;
  const auto by_time = std::span(order).first(line_count);
  sort_by_time(patch, by_time);
  std::array<Eigen::Vector2d, Patch::kMostLines> directions;
  for (std::size_t i = 0; i < line_count; ++i) directions[by_time[i]] = smoothed_direction(patch, by_time, i);

  RowBatch batch(within);
  std::array<LineSums, Patch::kMostLines> sums;
  for (std::size_t l = 0; l < line_count; ++l) sums[l].clear();
  std::array<Used, Patch::kMostSegments> segments;
  std::size_t used = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(patch.size); ++i) {
    if (!(patch.weight[i] > 0)) continue;
    const double weight = 1 / (static_cast<double>(patch.variance[i]) + segment_floor * segment_floor);
    segments[used] = {placed(patch, quadric, i), weight, patch.line[i]};
    sums[patch.line[i]].anchor_at(segments[used++].place.at, weight);
  }
  for (std::size_t l = 0; l < line_count; ++l) sums[l].anchor /= sums[l].weight;
  for (const Used& segment : std::span(segments).first(used)) {
    LineSums& sum = sums[segment.line];
    const Eigen::Vector2d& direction = directions[segment.line];
    const FitRow row = row_of(segment.place, quadric, sum.anchor, direction);
    batch.add(row, segment.weight);
    sum.add(row, segment.weight, direction.dot(row.segment<2>(1)));
  }
  for (const std::uint16_t l : by_time) {
    const LineSums& sum = sums[l];
    if (sum.segments == 0) continue;
    LineGroup& line = lines[static_cast<std::size_t>(size++)];
    line.time = patch.lines[l].time;
    line.offset_row = sum.rows / sum.weight;
    line.offset_variance = 1 / sum.weight;
    line.tilt_variance = 0;
    batch.add(line.offset_row, -sum.weight);
    within_freedom += sum.segments - 1;
    const double spread = sum.spread();
    if (sum.segments < 2 || !(spread > 0.01 * sum.weight)) continue;
    line.tilt_row = (sum.rows_along - sum.along * line.offset_row) / spread;
    line.tilt_variance = 1 / spread;
    batch.add(line.tilt_row, -spread);
    within_freedom -= 1;
  }
  batch.flush();
}

void LineGroups::scale_to(const Eigen::Matrix<double, 10, 1>& surface) {
  const double squares = squares_about(within, surface);
  const double factor = std::max(0.05, (1 + std::max(0.0, squares)) / (1 + within_freedom));
  for (int i = 0; i < size; ++i) {
    lines[static_cast<std::size_t>(i)].offset_variance *= factor / segment_factor;
    lines[static_cast<std::size_t>(i)].tilt_variance *= factor / segment_factor;
  }
  segment_factor = factor;
}

}  // namespace linescope
