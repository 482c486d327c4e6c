// The sheet traced through the prism against Eqs 3.4-3.10 and against Snell's law written with angles.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "acquire/twin/prism.hpp"
#include "acquire/twin/prism_sheet.hpp"
#include "common/units.hpp"

namespace linescope::twin {
namespace {

using Eigen::Vector3d;

constexpr double kBaseline = 6.0;
const double kAlpha = radians_from_degrees(14.0);

PrismSheet sheet(double prism_index = 1.53, double medium_index = 1.33) {
  PrismOptions options;
  options.refracted_sheet = true;
  options.prism_index = prism_index;
  options.medium_index = medium_index;
  auto made = PrismSheet::create(kBaseline, kAlpha, options);
  EXPECT_TRUE(made) << made.error().message;
  return *made;
}

double angle_between(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

TEST(PrismSheet, MiddleRayDeviatesByGammaOfEquation38) {
  const PrismSheet traced = sheet();
  const auto middle = traced.ray(0);
  ASSERT_TRUE(middle);
  EXPECT_NEAR(angle_between(middle->direction, Vector3d::UnitZ()), kAlpha, 1e-9);
  const auto closed = prism_angles({1.0, 1.53, 1.33}, traced.apex());
  ASSERT_TRUE(closed);
  EXPECT_NEAR(angle_between(middle->direction, Vector3d::UnitZ()), closed->gamma, 1e-9);
  // Bent towards the optical axis (y down is towards it: the fibre sits above), from the baseline's end.
  EXPECT_GT(middle->direction.y(), 0);
  EXPECT_NEAR(middle->origin.y(), -kBaseline, 1e-12);
}

TEST(PrismSheet, EveryRayObeysSnellAtBothFaces) {
  const PrismSheet traced = sheet();
  const Vector3d face2{0, -std::sin(traced.apex()), std::cos(traced.apex())};
  for (const double in_air : {-0.35, -0.2, 0.05, 0.3}) {
    const auto ray = traced.ray(in_air);
    ASSERT_TRUE(ray);
    const double in_prism = std::asin(std::sin(in_air) / 1.53);
    const Vector3d inside{std::sin(in_prism), 0, std::cos(in_prism)};
    EXPECT_NEAR(1.53 * std::sin(angle_between(inside, face2)),
                1.33 * std::sin(angle_between(ray->direction, face2)), 1e-9);
    EXPECT_NEAR(inside.cross(face2).dot(ray->direction), 0, 1e-12)
        << "refraction stays in the plane of incidence";
    EXPECT_NEAR(ray->direction.norm(), 1, 1e-12);
  }
}

TEST(PrismSheet, TracedRaysLieOnTheSheet) {
  const PrismSheet traced = sheet();
  for (const double in_air : {-0.38, -0.1, 0.0, 0.25, 0.38}) {
    const auto ray = traced.ray(in_air);
    ASSERT_TRUE(ray);
    for (const double way : {8.0, 15.0, 23.0}) {
      const SheetPlace place = traced.at(ray->origin + way * ray->direction);
      EXPECT_NEAR(place.offset, 0, 1e-8);
      EXPECT_NEAR((place.direction - ray->direction).norm(), 0, 1e-7);
    }
  }
}

TEST(PrismSheet, OffsetIsTheDistanceToTheSheet) {
  const PrismSheet traced = sheet();
  const auto ray = traced.ray(0.3);
  const Vector3d foot = ray->origin + 15 * ray->direction;
  // Sheet normal from two neighbours on the sheet: along the ray, and across to a ray beside it.
  const auto beside = traced.ray(0.3001);
  const Vector3d across = beside->origin + 15 * beside->direction - foot;
  Vector3d normal = ray->direction.cross(across).normalized();
  if (normal.y() < 0) normal = -normal;
  EXPECT_NEAR(traced.at(foot + 0.05 * normal).offset, 0.05, 2e-4);
  EXPECT_NEAR(traced.at(foot - 0.05 * normal).offset, -0.05, 2e-4);
}

TEST(PrismSheet, RaysOffTheMiddleAreBentMore) {
  const PrismSheet traced = sheet();
  const auto slope = [](const SheetRay& ray) { return ray.direction.y() / ray.direction.z(); };
  const double middle = slope(*traced.ray(0)), side = slope(*traced.ray(0.4)),
               other = slope(*traced.ray(-0.4));
  EXPECT_GT(side, middle + 0.02);
  EXPECT_NEAR(side, other, 1e-12);
}

TEST(PrismSheet, ImpossibleDeviationIsRefused) {
  PrismOptions options;
  options.medium_index = 1.52;  // almost no step of index: nothing bends by 30 degrees
  const auto made = PrismSheet::create(kBaseline, radians_from_degrees(30), options);
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().message.find("reflects totally"), std::string::npos);
}

}  // namespace
}  // namespace linescope::twin
