// The laser's surface as inverse depth over the viewing ray: 1/z = c0 x + c1 y + c2 [+ c3 x^2 + c4 x y + c5
// y^2].
//
// Three coefficients are a plane, exactly. The fan behind a prism is bent as a cone is: its distance from the
// plane grows with x^2 z, which is the quadratic form, exactly to first order (docs/calibrating.md). Both are
// linear in their coefficients.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tools/calibrate/laser_points.hpp"

namespace linescope::calibrate {

struct Sheet {
  Eigen::Matrix<double, 6, 1> c = Eigen::Matrix<double, 6, 1>::Zero();  ///< 1/mm
  double inverse_depth(double x, double y) const {
    return c(0) * x + c(1) * y + c(2) + c(3) * x * x + c(4) * x * y + c(5) * y * y;
  }
  /// Signed distance of a point, mm; exact for a plane, to first order else.
  double distance(const LaserPoint& p) const;
  /// How far the line in the picture lies from where this surface would put it, px.
  double pixels(const LaserPoint& p) const;
};

enum class SheetForm { plane = 3, bent = 6 };

struct SheetFitOptions {
  double inlier_px = 2.5;  ///< points further from the surface are taken for another light; at least
  int trials = 400;        ///< of the random start
};

/// Robust: the best of many planes through three points, then iteratively reweighted least squares in the
/// picture's pixels, points beyond the limit left out. `inliers`, if given, gets one flag per point, picture
/// by picture. Nothing when the points fix no surface.
std::optional<Sheet> fit_sheet(const std::vector<const LaserPicture*>& pictures, SheetForm form,
                               const SheetFitOptions& options,
                               std::vector<std::vector<bool>>* inliers = nullptr);

}  // namespace linescope::calibrate
