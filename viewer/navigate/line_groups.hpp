// The used segments of a patch, summed up line by line: what a line says by its mean height, by its slope
// along itself, and what is left once both are taken out.
#pragma once

#include <Eigen/Core>
#include <array>

#include "viewer/navigate/patch.hpp"
#include "viewer/navigate/robust_quadric.hpp"

namespace linescope {

/// Rows are the ten averaged features of Cubic, then the measured value.
struct LineGroup {
  using Row = Eigen::Matrix<double, 11, 1>;
  Nanoseconds time = 0;
  Row offset_row = Row::Zero();  ///< means over the line
  Row tilt_row = Row::Zero();    ///< slopes along the line
  double offset_variance = 0;    ///< of the mean height by the segments' own errors, mm^2
  double tilt_variance = 0;      ///< of the slope, 1; 0: the line is too short here to have one
};

struct LineGroups {
  LineGroups(const Patch& patch, const Quadric& quadric, double segment_floor);

  const LineGroup& in_time(int i) const { return lines[order[static_cast<std::size_t>(i)]]; }

  int size = 0;
  std::array<LineGroup, Patch::kMostLines> lines;
  std::array<std::uint16_t, Patch::kMostLines> order;                                 ///< by time
  Eigen::Matrix<double, 10, 10> within_left = Eigen::Matrix<double, 10, 10>::Zero();  ///< lower triangle
  Eigen::Matrix<double, 10, 1> within_right = Eigen::Matrix<double, 10, 1>::Zero();
  double segment_factor =
      1;  ///< variance of segments within lines over what their points' deviations promise
};

}  // namespace linescope
