// Curves and surfaces fitted to points, as the thesis judges its results (Eqs 4.16-4.19). Millimetres.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace linescope {

using Points2 = std::vector<Eigen::Vector2d>;
using Points3 = std::vector<Eigen::Vector3d>;

struct Circle {
  Eigen::Vector2d centre{0, 0};
  double radius = 0;
  double deviation = 0;  ///< standard deviation of the points' distance from the circle
};

/// Eq 4.16 as linear least squares in (a, b, a^2 + b^2 - r^2): the algebraic fit. On a short arc with noise
/// it comes out too small. Nothing for fewer than three points or points on a line.
std::optional<Circle> algebraic_circle(const Points2& points);

/// Least squares of the points' distances from the circle (Gauss-Newton from the algebraic fit).
std::optional<Circle> geometric_circle(const Points2& points);

/// y = a x^2 + b x + c (Eqs 4.18, 4.19).
struct Parabola {
  double a = 0, b = 0, c = 0;
  double at(double x) const { return (a * x + b) * x + c; }
};
std::optional<Parabola> fitted_parabola(const Points2& points);

struct FittedWall {
  Eigen::Vector3d centre{0, 0, 0};
  Eigen::Vector3d normal{0, 0, 1};  ///< unit, either side
  double deviation = 0;             ///< of the points' distances
};
std::optional<FittedWall> fitted_wall(const Points3& points);

/// A cylinder whose axis is not known: the direction in which the points' shadow is most nearly a circle.
struct FittedCylinder {
  Eigen::Vector3d axis{0, 1, 0};  ///< unit, either way
  Circle section;
};
std::optional<FittedCylinder> fitted_cylinder(const Points3& points);

struct FittedBall {
  Eigen::Vector3d centre{0, 0, 0};
  double radius = 0;
  double deviation = 0;  ///< of the points' distances from it
};
/// Least squares of the points' distances from the sphere (Gauss-Newton from the algebraic fit). Nothing for
/// fewer than four points or points in a plane.
std::optional<FittedBall> fitted_ball(const Points3& points);

/// Points along `axis` onto a plane across it.
Points2 shadow(const Points3& points, const Eigen::Vector3d& axis);

}  // namespace linescope
