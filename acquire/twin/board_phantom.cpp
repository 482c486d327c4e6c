#include "acquire/twin/board_phantom.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace linescope::twin {
namespace {

using Eigen::Vector3d;

constexpr double kWhite = 0.85, kBlack = 0.12;
constexpr double kBlurPx = 0.6;  // sigma of lens and pixel together

double step(double distance, double sigma) {
  return 0.5 * std::erfc(-distance / (std::sqrt(2.0) * sigma));
}

// +1 and -1 in turn between the lines of a grid at 0, 1 .. `squares` (in squares), 0 outside, blurred. The
// blur of a straight edge is exact; where two edges cross, the product is right to first order.
struct Stripes {
  double sign = 0;    ///< mean of the alternating sign over the pixel
  double inside = 0;  ///< share of the pixel within the pattern
};

Stripes stripes(double x, int squares, double sigma) {
  Stripes result;
  result.inside = step(x, sigma) - step(x - squares, sigma);
  result.sign = step(x, sigma);
  const int nearest = static_cast<int>(std::lround(x));
  const int reach = static_cast<int>(std::ceil(5 * sigma)) + 1;
  const int first = std::clamp(nearest - reach, 1, squares), last = std::clamp(nearest + reach, 0, squares);
  if (first > 1) result.sign = first % 2 == 0 ? -1 : 1;
  for (int line = first; line <= last; ++line) {
    const double jump = line == squares ? 1 : 2;
    result.sign += (line % 2 == 0 ? 1 : -1) * jump * step(x - line, sigma);
  }
  return result;
}

}  // namespace

Rigid<PhantomFrame, Board> phantom_from_board(const BoardPattern& pattern) {
  Eigen::Matrix3d axes;
  axes << Vector3d::UnitY(), Vector3d::UnitX(), -Vector3d::UnitZ();
  const double x = (0.5 * pattern.columns - 1) * pattern.square_mm;
  const double y = (0.5 * pattern.rows - 1) * pattern.square_mm;
  return {Eigen::Quaterniond(axes), Vector3d(-y, -x, 0)};
}

BoardPhantom::BoardPhantom(const BoardPattern& pattern)
    : pattern_(pattern), board_from_phantom_(phantom_from_board(pattern).inverse()) {}

double BoardPhantom::reflectance(const Vector3d& place, const Vector3d& right, const Vector3d& down) const {
  const Vector3d at = (board_from_phantom_ * place) / pattern_.square_mm + Vector3d(1, 1, 0);
  const Vector3d r = board_from_phantom_.rotate(right) / pattern_.square_mm;
  const Vector3d d = board_from_phantom_.rotate(down) / pattern_.square_mm;
  const auto sigma = [&](int axis) { return kBlurPx * std::hypot(r[axis], d[axis]) + 1e-9; };
  const Stripes x = stripes(at.x(), pattern_.columns, sigma(0));
  const Stripes y = stripes(at.y(), pattern_.rows, sigma(1));
  // The corner square is black: there both signs are +1.
  const double black = 0.5 * (x.inside * y.inside + x.sign * y.sign);
  return kWhite + black * (kBlack - kWhite);
}

std::string BoardPhantom::json() const {
  return fmt::format(R"({{"kind":"board","columns":{},"rows":{},"square_mm":{}}})", pattern_.columns,
                     pattern_.rows, pattern_.square_mm);
}

}  // namespace linescope::twin
