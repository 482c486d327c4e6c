#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "acquire/reconstruct/ray_table.hpp"

namespace linescope {
namespace {

CameraModel barrel() {
  return {160, 120, 130, 130, 0, 79.5, 59.5, {-0.38, 0.17, 1e-3, -5e-4, -0.03}};
}

TEST(RayTable, AgreesWithUndistortionOfThePointBetweenPixels) {
  const CameraModel camera = barrel();
  const RayTable table(camera);
  const auto exact = [&](double u, double v) { return camera.normalised_from_pixel({u, v}); };
  std::mt19937 generator(3);
  std::uniform_real_distribution<float> u(0, 159), v(0, 119);
  for (int i = 0; i < 2000; ++i) {
    const float a = u(generator), b = v(generator);
    const auto x = static_cast<double>(a), y = static_cast<double>(b);
    const Eigen::Vector2d here = exact(x, y);
    // A straight line between two pixels is off by up to an eighth of the second difference; the third
    // differences change that by a few per cent within a pixel, and single precision adds 1e-7.
    const Eigen::Vector2d bent = (exact(x + 1, y) - 2 * here + exact(x - 1, y)).cwiseAbs() +
                                 (exact(x, y + 1) - 2 * here + exact(x, y - 1)).cwiseAbs();
    const Eigen::Vector2d bound = bent / 8 * 1.1 + Eigen::Vector2d::Constant(1e-7);
    for (const ProfileAxis axis : {ProfileAxis::column, ProfileAxis::row}) {
      const Ray ray = table.along(axis).at(a, b);
      EXPECT_NEAR(ray.x, here.x(), bound.x()) << a << ", " << b;
      EXPECT_NEAR(ray.y, here.y(), bound.y()) << a << ", " << b;
    }
  }
}

TEST(RayTable, StepsAreTheChangeAlongTheProfile) {
  const CameraModel camera = barrel();
  const RayTable table(camera);
  const auto exact = [&](double u, double v) { return camera.normalised_from_pixel({u, v}); };
  const Ray column = table.along(ProfileAxis::column).at(40, 30.5F),
            row = table.along(ProfileAxis::row).at(40.5F, 30);
  EXPECT_NEAR(column.y_step, exact(40, 31).y() - exact(40, 30).y(), 1e-7);
  EXPECT_NEAR(column.x_step, exact(40, 31).x() - exact(40, 30).x(), 1e-7);
  EXPECT_NEAR(row.x_step, exact(41, 30).x() - exact(40, 30).x(), 1e-7);
}

TEST(RayTable, CornersBelongToThePictureAndBeyondIsNothing) {
  const RayTable table(barrel());
  for (const ProfileAxis axis : {ProfileAxis::column, ProfileAxis::row}) {
    for (const auto& [u, v] : {std::pair{0.0F, 0.0F}, std::pair{159.0F, 0.0F}, std::pair{0.0F, 119.0F},
                               std::pair{159.0F, 119.0F}}) {
      EXPECT_TRUE(std::isfinite(table.along(axis).at(u, v).x)) << u << ", " << v;
    }
    const float nan = std::nanf("");
    for (const auto& [u, v] :
         {std::pair{-0.1F, 5.0F}, std::pair{159.1F, 5.0F}, std::pair{5.0F, -0.1F}, std::pair{5.0F, 119.1F},
          std::pair{nan, 5.0F}, std::pair{5.0F, nan}, std::pair{1e30F, 5.0F}}) {
      EXPECT_FALSE(std::isfinite(table.along(axis).at(u, v).x)) << u << ", " << v;
    }
  }
}

TEST(RayTable, WhereTheLensCannotBeInvertedThereIsNoRay) {
  CameraModel camera = barrel();
  camera.fx = camera.fy = 60;  // a view so wide that the rim lies beyond the fold of k1 = -0.38
  camera.distortion = {-0.38, 0, 0, 0, 0};
  const RayTable table(camera);
  EXPECT_FALSE(std::isfinite(table.along(ProfileAxis::column).at(0, 0).x));
  EXPECT_TRUE(std::isfinite(table.along(ProfileAxis::column).at(80, 60).x));
}

}  // namespace
}  // namespace linescope
