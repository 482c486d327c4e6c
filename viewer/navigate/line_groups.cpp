#include "viewer/navigate/line_groups.hpp"

#include <algorithm>
#include <cmath>

namespace linescope {
namespace {

using Row = LineGroup::Row;

/// Mean over a segment of the ten features, exact for points spread evenly about the mean along a straight
/// piece.
Row row_of(const Patch& patch, std::size_t i) {
  const double x = static_cast<double>(patch.x[i]), y = static_cast<double>(patch.y[i]);
  const double a = static_cast<double>(patch.sx[i]), b = static_cast<double>(patch.sy[i]);
  Row row;
  row << 1, x, y, x * x + a * a, x * y + a * b, y * y + b * b, x * (x * x + 3 * a * a),
      x * (x * y + 2 * a * b) + y * a * a, y * (x * y + 2 * a * b) + x * b * b, y * (y * y + 3 * b * b),
      static_cast<double>(patch.z[i]);
  return row;
}

/// Weighted sums of one line.
struct LineSums {
  double weight = 0;
  double along = 0;
  double along_squared = 0;
  Row rows = Row::Zero();
  Row rows_along = Row::Zero();
  int segments = 0;
};

}  // namespace

LineGroups::LineGroups(const Patch& patch, const Quadric& quadric, double segment_floor) {
  std::array<LineSums, Patch::kMostLines> sums;
  const auto line_count = static_cast<std::size_t>(patch.line_count);
  std::array<Eigen::Vector2d, Patch::kMostLines> directions;
  for (std::size_t l = 0; l < line_count; ++l)
    directions[l] = patch.lines[l].direction.cast<double>().normalized();

  Eigen::Matrix<double, 11, 11> all = Eigen::Matrix<double, 11, 11>::Zero();
  for (std::size_t i = 0; i < static_cast<std::size_t>(patch.size); ++i) {
    if (!(patch.weight[i] > 0)) continue;
    const double w = 1 / (static_cast<double>(patch.variance[i]) + segment_floor * segment_floor);
    const Row row = row_of(patch, i);
    LineSums& sum = sums[patch.line[i]];
    const double s = directions[patch.line[i]].dot(Eigen::Vector2d(row[1], row[2]));
    all.selfadjointView<Eigen::Lower>().rankUpdate(row, w);
    sum.weight += w;
    sum.along += w * s;
    sum.along_squared += w * s * s;
    sum.rows += w * row;
    sum.rows_along += (w * s) * row;
    ++sum.segments;
  }

  double freedom = 0;
  for (std::size_t l = 0; l < line_count; ++l) {
    const LineSums& sum = sums[l];
    if (sum.segments == 0) continue;
    order[static_cast<std::size_t>(size)] = static_cast<std::uint16_t>(size);
    LineGroup& line = lines[static_cast<std::size_t>(size++)];
    line.time = patch.lines[l].time;
    line.offset_row = sum.rows / sum.weight;
    line.offset_variance = 1 / sum.weight;
    all.selfadjointView<Eigen::Lower>().rankUpdate(line.offset_row, -sum.weight);
    const double spread = sum.along_squared - sum.along * sum.along / sum.weight;
    freedom += sum.segments - 1;
    if (sum.segments < 2 || !(spread > 0.01 * sum.weight)) continue;
    line.tilt_row = (sum.rows_along - sum.along * line.offset_row) / spread;
    line.tilt_variance = 1 / spread;
    all.selfadjointView<Eigen::Lower>().rankUpdate(line.tilt_row, -spread);
    freedom -= 1;
  }

  // What remains within the lines tells how much larger the segments' errors are than promised.
  Row residual = Row::Zero();
  residual.head<6>() = -quadric.b;
  residual[10] = 1;
  const double squares = residual.dot(all.selfadjointView<Eigen::Lower>() * residual);
  segment_factor = std::max(0.05, (1 + std::max(0.0, squares)) / (1 + std::max(0.0, freedom)));
  for (int i = 0; i < size; ++i) {
    lines[static_cast<std::size_t>(i)].offset_variance *= segment_factor;
    lines[static_cast<std::size_t>(i)].tilt_variance *= segment_factor;
  }
  within_left = all.topLeftCorner<10, 10>() / segment_factor;
  within_right = all.bottomLeftCorner<1, 10>().transpose() / segment_factor;
  std::sort(order.begin(), order.begin() + size, [this](std::uint16_t a, std::uint16_t b) {
    return lines[a].time < lines[b].time || (lines[a].time == lines[b].time && a < b);
  });
}

}  // namespace linescope
