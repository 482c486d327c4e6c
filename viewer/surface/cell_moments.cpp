#include "viewer/surface/cell_moments.hpp"

#include "viewer/surface/line_quantizer.hpp"

namespace linescope {
namespace {

// The pairs of axes behind xx xy xz yy yz zz.
constexpr std::array<std::array<std::size_t, 2>, 6> kPairs{{{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}}};

}  // namespace

void LineParts::add(const std::array<std::int64_t, 4>& part) {
  const double inverse = 1.0 / static_cast<double>(part[3]);
  for (std::size_t i = 0; i < 4; ++i) first[i] += part[i];
  for (std::size_t i = 0; i < 6; ++i) {
    const double square =
        static_cast<double>(part[kPairs[i][0]]) * static_cast<double>(part[kPairs[i][1]]) * inverse;
    second[i] += static_cast<std::int64_t>(square + (square < 0 ? -0.5 : 0.5));
  }
  ++count;
}

CellStatistics statistics_of(const CellContent& cell) {
  const MomentSums& s = cell.sums;
  CellStatistics result;
  if (!cell.occupied()) return result;
  const std::array<std::int64_t, 6> second{s.squares[0], s.products[0], s.products[2],
                                           s.squares[1], s.products[1], s.squares[2]};
  const double inverse = 1.0 / static_cast<double>(s.weight());
  constexpr double unit = 1.0 / kSteps;
  result.weight = static_cast<double>(s.weight());
  result.points = static_cast<double>(s.points());
  result.lines = cell.lines;
  result.parts = static_cast<double>(cell.parts.count);
  result.parts_weight = static_cast<double>(cell.parts.first[3]);
  std::array<double, 3> mean{};  // in steps
  for (std::size_t i = 0; i < 3; ++i) {
    mean[i] = static_cast<double>(s.first[i]) * inverse;
    result.mean[i] = (mean[i] + 0.5) * unit;  // a point lies in the middle of its step
    result.towards[i] = cell.towards[i] * (1.0 / 256);
    result.parts_sum[i] = static_cast<double>(cell.parts.first[i]) * unit;
  }
  for (std::size_t i = 0; i < 6; ++i) {
    const double square = mean[kPairs[i][0]] * mean[kPairs[i][1]];
    result.covariance[i] = (static_cast<double>(second[i]) * inverse - square) * (unit * unit);
    result.parts_squares[i] = static_cast<double>(cell.parts.second[i]) * (unit * unit);
  }
  return result;
}

}  // namespace linescope
