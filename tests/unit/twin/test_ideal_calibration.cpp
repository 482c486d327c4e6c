// The calibration that the twin hands out against the product's camera model and against its own light.
#include <gtest/gtest.h>

#include <cmath>

#include "acquire/twin/prism_sheet.hpp"
#include "acquire/twin/view_rays.hpp"
#include "common/laser_plane.hpp"
#include "common/units.hpp"
#include "twin_fixture.hpp"

namespace linescope::twin {
namespace {

TEST(IdealCalibration, PassesTheProductsOwnChecks) {
  for (const char* noise : {"ideal", "manufacturer", "thesis"}) {
    TwinOptions options = demo_twin();
    ASSERT_TRUE(apply_noise_preset(options, noise));
    const auto valid = validate(experiment(options)->calibration());
    EXPECT_TRUE(valid) << valid.error().message;
  }
}

TEST(IdealCalibration, IsExactForPinholeAndFlatSheet) {
  TwinOptions options = demo_twin();
  options.instrument.latency = 7 * kMillisecond;
  const Calibration calibration = experiment(options)->calibration();
  const BaselineForm form = baseline_form(calibration.laser);
  EXPECT_NEAR(form.baseline_mm, 6.0, 1e-12);
  EXPECT_NEAR(form.alpha_rad, radians_from_degrees(14), 1e-12);
  EXPECT_NEAR(form.tilt_rad, 0, 1e-12);
  EXPECT_EQ(calibration.camera_latency, 7 * kMillisecond);
  const ViewRays rays(options.instrument.lens, {}, 1.33);
  for (const double u : {60.0, 179.0, 300.0}) {
    for (const double v : {10.0, 118.0, 200.0}) {
      const ViewRay ray = rays.at(u, v);
      EXPECT_NEAR((calibration.camera.project(15 * ray.direction) - Eigen::Vector2d(u, v)).norm(), 0, 1e-8);
    }
  }
}

// What is left of a flat port after the best pinhole: small, but not nothing.
TEST(IdealCalibration, FitsTheFlatPortToAFractionOfAPixel) {
  TwinOptions options = demo_twin();
  options.optics.port.refraction = true;
  const Calibration calibration = experiment(options)->calibration();
  const ViewRays rays(options.instrument.lens, options.optics.port, options.optics.prism.medium_index);
  double worst = 0;
  for (int u = 40; u < 340; u += 20) {
    for (int v = 5; v < 235; v += 20) {
      const ViewRay ray = rays.at(u, v);
      if (!ray.lit()) continue;
      for (const double z : {9.0, 15.0, 21.0}) {
        const Eigen::Vector3d point = ray.origin + ray.direction * ((z - ray.origin.z()) / ray.direction.z());
        worst = std::max(worst, (calibration.camera.project(point) - Eigen::Vector2d(u, v)).norm());
      }
    }
  }
  EXPECT_LT(worst, 1.5);
  EXPECT_GT(worst, 1e-4) << "a port is no pinhole";
}

TEST(IdealCalibration, PlaneRunsThroughTheBentSheet) {
  TwinOptions options = demo_twin();
  options.optics.prism.refracted_sheet = true;
  const LaserPlane plane = experiment(options)->calibration().laser;
  const auto sheet = PrismSheet::create(6.0, options.instrument.alpha_rad, options.optics.prism);
  ASSERT_TRUE(sheet);
  double least = 1e9, most = -1e9;
  for (double angle = -0.38; angle <= 0.38; angle += 0.02) {
    const auto ray = sheet->ray(angle);
    ASSERT_TRUE(ray);
    const Eigen::Vector3d cv = ray->origin + 15 * ray->direction;
    const double off = plane.normal.dot(Eigen::Vector3d(cv.x(), -cv.y(), cv.z())) - plane.offset;
    least = std::min(least, off);
    most = std::max(most, off);
  }
  EXPECT_LT(least, -0.05);
  EXPECT_GT(most, 0.05);
  EXPECT_LT(most - least, 0.6);
}

}  // namespace
}  // namespace linescope::twin
