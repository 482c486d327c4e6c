// How well a scan of a body of known size shows that body: bias, precision and repeatability in the words of
// ASTM F2554, and the error of points that were in no fit. Millimetres, any frame.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/result.hpp"
#include "viewer/measure/shape_evaluation.hpp"

namespace linescope::calibrate {

struct ShapeCheckOptions {
  Shape shape = Shape::plane;
  double diameter_mm = 50;     ///< of cylinder or sphere, as measured by a caliper; 5 .. 1000
  int least_lines = 30;        ///< 10 .. 100000
  int least_passes = 2;        ///< over the body, to and fro; 1 .. 1000
  double least_extent_mm = 6;  ///< across the lines, of the scanned patch; 1 .. 1000
  double most_bias_mm = 0.5;   ///< all four: 0.001 .. 100
  double most_precision_mm = 0.5;
  double most_repeatability_mm = 0.3;
  double most_target_error_mm = 0.6;
};
Result<void> validate(const ShapeCheckOptions& options);

/// Points of one laser line, in the order of the scan.
using ScanLine = std::vector<Eigen::Vector3d>;

/// One scanned point against the body of known size.
struct ShapeResidual {
  double along = 0, across = 0;  ///< mm, on the patch: along the scan, along the laser line
  double distance = 0;           ///< mm, positive outside
};

struct ShapeCheck {
  /// Systematic error of the size: fitted less true diameter; of a plane, by how much the scanned patch
  /// bulges (its sagitta along the scan).
  double bias_mm = 0;
  double diameter_mm = 0;       ///< fitted; 0: a plane has none
  double precision_mm = 0;      ///< standard deviation of all points about the body of known size
  double repeatability_mm = 0;  ///< standard deviation, over passes, of each pass's mean distance from it
  double target_error_mm =
      0;  ///< RMS distance of lines that were in no fit (every fifth) from the fit of the others
  double residual_mm = 0;  ///< RMS distance of the lines of that fit
  std::size_t lines = 0, points = 0, held_out_points = 0;
  std::size_t passes = 0;
  double extent_mm = 0;
  /// Per line: RMS distance, mean distance, way along the scan, number of the pass.
  std::vector<double> line_error_mm, line_mean_mm, line_way_mm;
  std::vector<std::size_t> line_pass;
  std::vector<ShapeResidual> residuals;  ///< some thousand of the points, evenly spread
};

/// Refuses (verdict.hpp): too few lines; too little variation (a patch too narrow for its size to be known, a
/// single pass).
Result<ShapeCheck> check_shape(const std::vector<ScanLine>& lines, const ShapeCheckOptions& options);

/// All limits that are exceeded, in one sentence.
Result<void> above_limit(const ShapeCheck& check, const ShapeCheckOptions& options);

/// Number of the pass (0, 1, ...) of each line: a new one begins where the scan turns back.
std::vector<std::size_t> passes_of(const std::vector<ScanLine>& lines);

}  // namespace linescope::calibrate
