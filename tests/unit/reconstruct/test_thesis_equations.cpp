#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "acquire/reconstruct/laser_surface.hpp"
#include "acquire/reconstruct/thesis_equations.hpp"
#include "common/calibration.hpp"
#include "common/camera_convention.hpp"
#include "common/euler.hpp"
#include "common/units.hpp"

namespace linescope {
namespace {

constexpr ThesisTriangulation kSystemTwo{609.9614, 359.5034, 239.4773, 6.0, 14 * std::numbers::pi / 180};

TEST(ThesisEquations, PrintedFormIsTheRayMeetingThePlane) {
  const LaserPlane plane = laser_plane_from_baseline(kSystemTwo.baseline_mm, kSystemTwo.alpha_rad);
  for (double u = 0; u < 720; u += 37) {
    for (double v = 0; v < 380; v += 19) {
      const auto printed = kSystemTwo.point(u, v);
      const auto general = ray_meets_plane(plane, (u - kSystemTwo.u_o) / kSystemTwo.focal_px,
                                           (kSystemTwo.v_o - v) / kSystemTwo.focal_px);
      ASSERT_TRUE(printed && general) << u << ", " << v;
      EXPECT_LT((*printed - *general).norm(), 1e-9 * general->norm());
      // and it lies on the sheet of Eq 4.3: y + z tan(alpha) = b
      EXPECT_NEAR(printed->y() + printed->z() * std::tan(kSystemTwo.alpha_rad), 6.0, 1e-9);
    }
  }
}

TEST(ThesisEquations, LinePlacesFollowFromThePrintedInstrument) {
  // v_o - v = b f / z - f tan(alpha): 214, 92 and 31 px above the principal point at 10, 15 and 20 mm.
  for (const auto& [depth, rows] : {std::pair{10.0, 214.0}, std::pair{15.0, 92.0}, std::pair{20.0, 31.0}}) {
    const auto p = kSystemTwo.point(kSystemTwo.u_o, kSystemTwo.v_o - rows);
    ASSERT_TRUE(p);
    EXPECT_NEAR(p->z(), depth, 0.05);
    EXPECT_DOUBLE_EQ(p->x(), 0);
  }
}

TEST(ThesisEquations, BelowTheHorizonOfTheLaserThereIsNoPoint) {
  const double horizon = kSystemTwo.v_o + kSystemTwo.focal_px * std::tan(kSystemTwo.alpha_rad);
  const LaserPlane plane = laser_plane_from_baseline(kSystemTwo.baseline_mm, kSystemTwo.alpha_rad);
  EXPECT_FALSE(kSystemTwo.point(300, horizon + 1));
  EXPECT_FALSE(ray_meets_plane(plane, 0, -(1 + 1e-6) * std::tan(kSystemTwo.alpha_rad)));
  EXPECT_TRUE(kSystemTwo.point(300, horizon - 1));
}

Eigen::Matrix3d sensor_rotation() {
  return quaternion_from_euler(
             {radians_from_degrees(30), radians_from_degrees(-20), radians_from_degrees(75)})
      .toRotationMatrix();
}

TEST(WorldTransform, Eq49IsTheGeneralFormWithIdentityHandEye) {
  const Eigen::Vector3d l_r(2, 5, -12), t_s(120, -40, 260), s_c(1.5, -0.7, 14);
  const Rigid<World, Endoscope> world_from_endoscope(Eigen::Quaterniond(sensor_rotation()), t_s);
  const Rigid<Endoscope, CameraCv> endoscope_from_camera(Eigen::Quaterniond::Identity(), l_r);
  const Eigen::Vector3d general = world_from_endoscope * endoscope_from_camera * s_c;
  EXPECT_LT((eq_4_9(sensor_rotation(), l_r, t_s, s_c) - general).norm(), 1e-12);
}

TEST(WorldTransform, Eq49OnPointsOfTheLeftHandedFrameMirrorsTheScene) {
  // Three points whose triple product tells the handedness, in OpenCV's frame and in the thesis's.
  const Eigen::Matrix3d right = (Eigen::Matrix3d() << 1, 0.2, 0, 0, 1, 0.3, 0.1, 0, 1).finished() * 10;
  Eigen::Matrix3d left;
  for (int i = 0; i < 3; ++i) left.col(i) = thesis_from_opencv(right.col(i));
  const auto placed = [](const Eigen::Matrix3d& points) {
    Eigen::Matrix3d world;
    for (int i = 0; i < 3; ++i)
      world.col(i) =
          eq_4_9(sensor_rotation(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), points.col(i));
    return world.determinant();
  };
  EXPECT_NEAR(placed(right), right.determinant(), 1e-9);
  EXPECT_NEAR(placed(left), -right.determinant(), 1e-9);
}

TEST(LaserSurface, PlaneMeetsTheRayWhereTheGeneralFormDoes) {
  LaserPlane plane;
  plane.normal = Eigen::Vector3d(0.1, 0.9, 0.3).normalized();
  plane.offset = 7;
  const PlaneSurface surface(plane);
  for (const auto& [x, y] : {std::pair{0.0, 0.0}, std::pair{0.3, -0.2}, std::pair{-0.5, 0.2}}) {
    const SurfaceHit hit = surface.meet(static_cast<float>(x), static_cast<float>(y));
    const auto expected = ray_meets_plane(plane, x, -y);  // OpenCV's y points down
    ASSERT_TRUE(expected);
    EXPECT_NEAR(hit.depth, expected->z(), 1e-5 * expected->z());
    // Slopes against differences; single precision knows the depth to 1e-5, and the slopes go with its
    // square.
    constexpr double h = 1e-4;
    const Eigen::Vector2d at(x, y);
    const auto depth = [&](double dx, double dy) {
      return plane.depth_along(at.x() + dx, -(at.y() + dy)).value();
    };
    const double by_x = (depth(h, 0) - depth(-h, 0)) / (2 * h), by_y = (depth(0, h) - depth(0, -h)) / (2 * h);
    EXPECT_NEAR(hit.by_x, by_x, 1e-5 * std::abs(by_x));
    EXPECT_NEAR(hit.by_y, by_y, 1e-5 * std::abs(by_y));
  }
}

}  // namespace
}  // namespace linescope
