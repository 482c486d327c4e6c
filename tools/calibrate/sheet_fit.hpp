// The laser's surface as inverse depth over the viewing ray: 1/z = c0 x + c1 y + c2 [+ c3 x^2 + c4 x y + c5
// y^2 [+ c6 x^3 + c7 x^2 y + c8 x y^2 + c9 y^3]].
//
// Three coefficients are a plane, exactly. The fan behind a prism is bent as a cone is: its distance from the
// plane grows with x^2 z, which is the quadratic form, exactly to first order; the cubic form also has the
// next order (docs/calibrating.md). All are linear in their coefficients.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "common/laser_bend.hpp"
#include "tools/calibrate/laser_points.hpp"

namespace linescope::calibrate {

using SheetTerms = Eigen::Matrix<double, 10, 1>;

struct Sheet {
  SheetTerms c = SheetTerms::Zero();  ///< 1/mm
  double inverse_depth(double x, double y) const;
  /// Its change with x and y.
  Eigen::Vector2d slope(double x, double y) const;
  /// Signed distance of a point, mm; exact for a plane, to first order else.
  double distance(const LaserPoint& p) const;
  /// How far the line in the picture lies from where this surface would put it, px.
  double pixels(const LaserPoint& p) const;
};

/// The value is the number of coefficients.
enum class SheetForm { plane = 3, quadratic = 6, cubic = 10 };

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

/// The sheet in the product's form: its first three coefficients, and the rest.
LaserPlane plane_of(const Sheet& sheet);
LaserBend bend_of(const Sheet& sheet);

/// And back.
Sheet sheet_of(const LaserPlane& plane, const LaserBend& bend);

}  // namespace linescope::calibrate
