#include <gtest/gtest.h>

#include "common/units.hpp"
#include "viewer/navigate/angle_difference.hpp"

namespace linescope {
namespace {

using Eigen::Vector3d;

TEST(AngleDifference, IsEquation53) {
  const Vector3d n(0.3, -2, 1), h(1, 1, 4);
  EXPECT_NEAR(angle_difference(n, h), std::acos(n.dot(h) / (n.norm() * h.norm())), 1e-14);
  EXPECT_DOUBLE_EQ(angle_difference({0, 0, 2}, {0, 3, 0}), std::acos(0.0));
  EXPECT_DOUBLE_EQ(angle_difference({0, 0, 1}, {0, 0, -5}), std::acos(-1.0));
}

TEST(AngleDifference, KeepsItsDigitsNearZero) {
  const double tiny = 1e-9;  // arccos of the printed form gives 0 here
  EXPECT_NEAR(angle_difference({0, 0, 1}, {tiny, 0, 1}), tiny, 1e-15);
}

TEST(ScreenTilts, SignsAndSizes) {
  const double a = radians_from_degrees(5), b = radians_from_degrees(-3);
  const auto tilts = screen_tilts({0, 0, 1}, {std::tan(a), std::tan(b), 1}, {1, 0, 0}, {0, 1, 0});
  ASSERT_TRUE(tilts);
  EXPECT_NEAR(tilts->right, a, 1e-12);
  EXPECT_NEAR(tilts->up, b, 1e-12);
}

TEST(ScreenTilts, ScreenNeedNotFaceTheSurface) {
  const auto tilts = screen_tilts({0, 0, 1}, {0.1, 0, 1}, Vector3d(1, 0, 1).normalized(), {0, 1, 0});
  ASSERT_TRUE(tilts);
  EXPECT_NEAR(tilts->right, std::atan(0.1), 1e-12);
  EXPECT_NEAR(tilts->up, 0, 1e-12);
}

TEST(ScreenTilts, NothingWhereTheScreenCannotShowIt) {
  EXPECT_FALSE(screen_tilts({0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 1, 0}));
  EXPECT_FALSE(screen_tilts({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}));
}

TEST(TipDistance, DepthRunsAlongTheAxis) {
  const double tilt = radians_from_degrees(60);
  const Vector3d axis(std::sin(tilt), 0, std::cos(tilt));
  const auto above = tip_distance(4 * axis, axis, {0, 0, 0}, {0, 0, 1});
  EXPECT_NEAR(above.depth, 4, 1e-12);
  EXPECT_NEAR(above.distance, 2, 1e-12);
  EXPECT_NEAR(tip_distance(-axis, axis, {0, 0, 0}, {0, 0, 1}).depth, -1, 1e-12);
}

}  // namespace
}  // namespace linescope
