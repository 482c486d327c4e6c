// The used segments of a patch, summed up line by line: what a line says by its mean height, by its slope
// along itself, and what is left once both are taken out.
#pragma once

#include <Eigen/Core>
#include <array>

#include "viewer/navigate/patch.hpp"
#include "viewer/navigate/robust_quadric.hpp"
#include "viewer/navigate/row_sums.hpp"

namespace linescope {

/// Rows are the ten averaged features of Cubic, then the measured value.
struct LineGroup {
  Nanoseconds time;
  FitRow offset_row;       ///< means over the line
  FitRow tilt_row;         ///< slopes along the line; meaningless where tilt_variance is 0
  double offset_variance;  ///< of the mean height by the segments' own errors, mm^2
  double tilt_variance;    ///< of the slope, 1; 0: the line is too short here to have one
};

struct LineGroups {
  /// `quadric` is the robust fit of the patch: a segment's distance from it is taken as an error along its
  /// line's view, so the segment belongs to where that view meets the quadric. (Taken where it lies, its x
  /// and y would carry the same error as its height, and the fit would find the view's direction in the
  /// noise.)
  LineGroups(const Patch& patch, const Quadric& quadric, double segment_floor);

  /// Compares what is left within the lines with a surface, and scales the segments' variances to it.
  void scale_to(const Eigen::Matrix<double, 10, 1>& surface);

  const LineGroup& in_time(int i) const { return lines[static_cast<std::size_t>(i)]; }

  int size = 0;
  std::array<LineGroup, Patch::kMostLines> lines;  ///< by time
  RowSums within = RowSums::Zero();  ///< what is left within the lines, segments weighted as promised
  double within_freedom = 0;         ///< segments less what offsets and tilts took
  double segment_factor =
      1;  ///< variance of segments within lines over what their points' deviations promise
};

}  // namespace linescope
