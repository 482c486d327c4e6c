// The operator's precision evaluation on shapes whose numbers are known.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

#include "viewer/measure/shape_evaluation.hpp"

namespace linescope {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

const Eigen::Quaterniond kTurn = Eigen::Quaterniond(0.8, 0.3, -0.4, 0.2).normalized();
const Vector3d kShift(30, 40, -80);

Vector3f placed(const Vector3d& p) {
  return (kTurn * p + kShift).cast<float>();
}

/// A cap of a sphere; radial noise of known standard deviation.
std::vector<Vector3f> cap(double radius, double noise, int count) {
  std::mt19937 dice(3);
  std::normal_distribution<double> normal(0, 1);
  std::uniform_real_distribution<double> even(0, 1);
  std::vector<Vector3f> points;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - 0.5 * even(dice), azimuth = 2 * std::numbers::pi * even(dice),
                 r = std::sqrt(1 - z * z);
    points.push_back(
        placed((radius + noise * normal(dice)) * Vector3d(r * std::cos(azimuth), r * std::sin(azimuth), z)));
  }
  return points;
}

std::vector<Vector3f> quarter_cylinder(double radius, double noise) {
  std::mt19937 dice(4);
  std::normal_distribution<double> normal(0, 1);
  std::vector<Vector3f> points;
  for (double along = -8; along <= 8; along += 0.25)
    for (double angle = -0.78; angle <= 0.78; angle += 0.01) {
      const double r = radius + noise * normal(dice);
      points.push_back(placed({r * std::sin(angle), along, r * std::cos(angle)}));
    }
  return points;
}

TEST(ShapeEvaluation, SphereGivesDiameterSpreadAndDifferenceFromTheNominalOne) {
  const auto e = evaluate_shape(cap(12.7, 0.1, 40'000), Shape::sphere, {}, 25.0);
  ASSERT_TRUE(e) << e.error().message;
  EXPECT_NEAR(e->diameter, 25.4, 0.03);
  EXPECT_NEAR(e->difference(), 0.4, 0.03);
  EXPECT_NEAR(e->difference_percent(), 1.6, 0.12);
  EXPECT_NEAR(e->mean, 0, 0.002);
  EXPECT_NEAR(e->deviation, 0.1, 0.002);
  EXPECT_NEAR(e->mean_size, 0.1 * std::sqrt(2 / std::numbers::pi), 0.002);  // of a normal distribution
  EXPECT_GT(e->maximum, 0.3);
  EXPECT_LT(e->maximum, 0.6);
  EXPECT_NEAR((e->centre - kShift).norm(), 0, 0.05);
  EXPECT_EQ(e->points, 40'000U);
}

TEST(ShapeEvaluation, CylinderOfTheThesisWithAnAxisNobodyTold) {
  const auto e = evaluate_shape(quarter_cylinder(24.5, 0.05), Shape::cylinder, {}, 49);
  ASSERT_TRUE(e) << e.error().message;
  EXPECT_NEAR(e->diameter, 49, 0.1);
  EXPECT_NEAR(e->deviation, 0.05, 0.002);
  EXPECT_NEAR(std::abs(e->direction.dot(kTurn * Vector3d::UnitY())), 1, 1e-5);
  // The axis goes through the true one, wherever along it.
  EXPECT_NEAR(e->direction.cross(e->centre - kShift).norm(), 0, 0.1);
  EXPECT_NE(sentence(*e).find("nominal 49.00"), std::string::npos) << sentence(*e);
}

TEST(ShapeEvaluation, PlaneHasNoDiameterWhateverTheNominalValue) {
  std::vector<Vector3f> points;
  for (int i = -20; i <= 20; ++i)
    for (int j = -20; j <= 20; ++j)
      points.push_back(placed({0.5 * i, 0.5 * j, (i + j) % 2 == 0 ? 0.2 : -0.2}));
  const auto e = evaluate_shape(points, Shape::plane, {}, 10);
  ASSERT_TRUE(e);
  EXPECT_NEAR(e->deviation, 0.2, 1e-3);
  EXPECT_NEAR(e->mean_size, 0.2, 1e-3);
  EXPECT_NEAR(e->maximum, 0.2, 1e-3);
  EXPECT_FALSE(e->has_difference());
  EXPECT_EQ(sentence(*e).find("diameter"), std::string::npos);
}

TEST(ShapeEvaluation, ARegionTakesOnlyItsPoints) {
  std::vector<Vector3f> points = cap(10, 0, 5'000);
  const std::size_t on_sphere = points.size();
  for (int i = 0; i < 500; ++i) points.emplace_back(500.0F, static_cast<float>(i), 0.0F);
  const Region near{.all = false, .centre = kShift, .radius = 11};
  const auto e = evaluate_shape(points, Shape::sphere, near);
  ASSERT_TRUE(e);
  EXPECT_EQ(e->points, on_sphere);
  EXPECT_NEAR(e->diameter, 20, 1e-3);
}

TEST(ShapeEvaluation, RefusesWithWhatToDo) {
  const auto few = evaluate_shape(cap(10, 0, 9), Shape::sphere, {});
  ASSERT_FALSE(few);
  EXPECT_EQ(few.error().code, ErrorCode::too_few);
  EXPECT_NE(few.error().message.find("9 points"), std::string::npos);
  std::vector<Vector3f> flat;
  for (int i = 0; i < 400; ++i)
    flat.emplace_back(static_cast<float>(i % 20), static_cast<float>(i) / 20.0F, 3.0F);
  for (const Shape round : {Shape::sphere, Shape::cylinder}) {
    const auto refused = evaluate_shape(flat, round, {});
    ASSERT_FALSE(refused) << name(round);
    EXPECT_EQ(refused.error().code, ErrorCode::too_little_variation);
  }
  EXPECT_EQ(evaluate_shape(flat, Shape::plane, {}, -1).error().code, ErrorCode::usage);
}

}  // namespace
}  // namespace linescope
