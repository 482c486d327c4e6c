// Fits against shapes whose numbers are known.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "viewer/measure/shape_fits.hpp"

namespace linescope {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Points2 arc(const Vector2d& centre, double radius, double half_angle, int count, double noise) {
  std::mt19937 dice(5);
  std::normal_distribution<double> normal(0, 1);
  Points2 points;
  for (int i = 0; i < count; ++i) {
    const double angle = half_angle * (2.0 * i / (count - 1) - 1);
    points.push_back(centre + (radius + noise * normal(dice)) * Vector2d(std::sin(angle), std::cos(angle)));
  }
  return points;
}

TEST(CircleFit, ReturnsAnExactArcByBothWays) {
  const Points2 points = arc({120.823, -39.893}, 23.322, 0.6, 200, 0);  // Eq 4.17
  for (const auto& circle : {algebraic_circle(points), geometric_circle(points)}) {
    ASSERT_TRUE(circle);
    EXPECT_NEAR(circle->radius, 23.322, 1e-6);
    EXPECT_NEAR((circle->centre - Vector2d(120.823, -39.893)).norm(), 0, 1e-6);
    EXPECT_NEAR(circle->deviation, 0, 1e-7);
  }
}

// Known of Eq 4.16 as linear least squares: on a short noisy arc the circle comes out too small.
TEST(CircleFit, AlgebraicOneIsTooSmallOnANoisyArcAndTheGeometricOneIsNot) {
  const Points2 points = arc({0, 0}, 25, 0.5, 20'000, 1.0);
  const auto algebraic = algebraic_circle(points), geometric = geometric_circle(points);
  EXPECT_LT(algebraic->radius, 23.5);
  EXPECT_NEAR(geometric->radius, 25, 0.4);
  EXPECT_NEAR(geometric->deviation, 1.0, 0.03);
}

TEST(CircleFit, RefusesTooFewPointsAndALine) {
  EXPECT_FALSE(algebraic_circle({{0, 0}, {1, 1}}));
  EXPECT_FALSE(geometric_circle({{0, 0}, {1, 1}, {2, 2}, {3, 3}}));
}

TEST(ParabolaFit, ReturnsEquation418) {
  Points2 points;
  for (double x = -12; x <= 12; x += 0.5) points.emplace_back(x, 0.033 * x * x + 0.518 * x + 42.450);
  const auto p = fitted_parabola(points);
  ASSERT_TRUE(p);
  EXPECT_NEAR(p->a, 0.033, 1e-9);
  EXPECT_NEAR(p->b, 0.518, 1e-9);
  EXPECT_NEAR(p->c, 42.450, 1e-9);
  EXPECT_NEAR(p->at(2), 0.033 * 4 + 0.518 * 2 + 42.450, 1e-9);
}

TEST(WallFit, FindsNormalAndSpread) {
  const Vector3d normal = Vector3d(0.2, -0.5, 0.8).normalized(), u = normal.unitOrthogonal(),
                 v = normal.cross(u);
  Points3 points;
  for (int i = -10; i <= 10; ++i)
    for (int j = -10; j <= 10; ++j)
      points.push_back(Vector3d(3, 4, 5) + i * u + j * v + ((i + j) % 2 == 0 ? 0.1 : -0.1) * normal);
  const auto wall = fitted_wall(points);
  ASSERT_TRUE(wall);
  EXPECT_NEAR(std::abs(wall->normal.dot(normal)), 1, 1e-6);
  EXPECT_NEAR(wall->deviation, 0.1, 0.001);
}

TEST(CylinderFit, FindsAnAxisNobodyToldIt) {
  const Eigen::Quaterniond turn = Eigen::Quaterniond(0.8, 0.3, -0.4, 0.2).normalized();
  Points3 points;
  for (double along = -5; along <= 5; along += 0.25)
    for (double angle = -0.6; angle <= 0.6; angle += 0.02)
      points.push_back(turn * Vector3d(24.55 * std::sin(angle), along, 24.55 * std::cos(angle)) +
                       Vector3d(300, 40, -80));
  const auto cylinder = fitted_cylinder(points);
  ASSERT_TRUE(cylinder);
  EXPECT_NEAR(std::abs(cylinder->axis.dot(turn * Vector3d::UnitY())), 1, 1e-6);
  EXPECT_NEAR(2 * cylinder->section.radius, 49.1, 0.01);
}

}  // namespace
}  // namespace linescope
