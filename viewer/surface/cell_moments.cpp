#include "viewer/surface/cell_moments.hpp"

namespace linescope {
namespace {

// The pairs of axes behind xx xy xz yy yz zz.
constexpr std::array<std::array<std::size_t, 2>, 6> kPairs{{{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}}};

}  // namespace

CellStatistics statistics_of(const MomentCell& cell) {
  const MomentSums& s = cell.sums;
  CellStatistics result;
  if (!cell.occupied()) return result;
  const std::array<std::int64_t, 3> first{s.x, s.y, s.z};
  const std::array<std::int64_t, 6> second{s.xx, s.xy, s.xz, s.yy, s.yz, s.zz};
  const double inverse = 1.0 / static_cast<double>(s.w);
  constexpr double unit = 1.0 / kSteps;
  result.weight = static_cast<double>(s.w);
  result.points = static_cast<double>(s.points);
  result.lines = cell.lines;
  std::array<double, 3> mean{};  // in steps
  for (std::size_t i = 0; i < 3; ++i) {
    mean[i] = static_cast<double>(first[i]) * inverse;
    result.mean[i] = (mean[i] + 0.5) * unit;  // a point lies in the middle of its step
    result.towards[i] = cell.towards[i] * (1.0 / 256);
  }
  for (std::size_t i = 0; i < 6; ++i) {
    const double square = mean[kPairs[i][0]] * mean[kPairs[i][1]];
    result.covariance[i] = (static_cast<double>(second[i]) * inverse - square) * (unit * unit);
    result.lines_apart[i] =
        (static_cast<double>(cell.lines_apart[i]) - square * result.weight) * (unit * unit);
  }
  return result;
}

}  // namespace linescope
