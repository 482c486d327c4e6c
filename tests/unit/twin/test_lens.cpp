// The twin's lens and port against OpenCV's projection and Snell's law.
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/calib3d.hpp>

#include "acquire/twin/lens.hpp"
#include "acquire/twin/view_rays.hpp"

namespace linescope::twin {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Vector2d opencv_pixel(const LensNumbers& lens, const Vector3d& point) {
  const cv::Matx33d matrix(lens.fx, 0, lens.cx, 0, lens.fy, lens.cy, 0, 0, 1);
  const std::vector<double> distortion(lens.distortion.begin(), lens.distortion.end());
  std::vector<cv::Point2d> pixels;
  cv::projectPoints(std::vector<cv::Point3d>{{point.x(), point.y(), point.z()}}, cv::Vec3d(0, 0, 0),
                    cv::Vec3d(0, 0, 0), matrix, distortion, pixels);
  return {pixels[0].x, pixels[0].y};
}

TEST(TwinLens, LandsWhereOpenCvSays) {
  for (const char* name : {"camera-i", "camera-ii", "camera-ii-320"}) {
    const LensNumbers numbers = instrument_from_name(name)->lens;
    for (const Vector2d& xy :
         {Vector2d(0, 0), Vector2d(0.3, -0.2), Vector2d(-0.25, 0.31), Vector2d(0.1, 0.38)}) {
      EXPECT_NEAR((Lens(numbers).pixel(xy) - opencv_pixel(numbers, {xy.x(), xy.y(), 1})).norm(), 0, 1e-9)
          << name;
    }
  }
}

TEST(TwinLens, RayOfAPixelLandsOnThatPixelInOpenCv) {
  const LensNumbers numbers = instrument_from_name("camera-ii")->lens;
  int inside = 0;
  for (int v = 0; v < numbers.height; v += 7) {
    for (int u = 0; u < numbers.width; u += 7) {
      const auto slope = Lens(numbers).slope(u, v);
      if (!slope) continue;
      ++inside;
      EXPECT_NEAR((opencv_pixel(numbers, {slope->x(), slope->y(), 1}) - Vector2d(u, v)).norm(), 0, 1e-7);
    }
  }
  EXPECT_GT(inside, 35 * 52 * 3 / 4) << "most of the picture has light";
}

TEST(TwinLens, NoLightBeyondTheFoldOfThePolynomial) {
  const LensNumbers numbers = instrument_from_name("camera-ii")->lens;
  EXPECT_FALSE(Lens(numbers).slope(0, 0));
  EXPECT_TRUE(Lens(numbers).slope(180, 5));
}

TEST(TwinPort, RefractsAsSnellSays) {
  PortOptions port;
  port.refraction = true;
  LensNumbers numbers;
  numbers.distortion = {};
  const ViewRays rays(numbers, port, 1.33);
  for (const double u : {10.0, 100.0, 250.0}) {
    const ViewRay ray = rays.at(u, numbers.cy);
    const double in_air = std::atan((u - numbers.cx) / (numbers.fx / 1.33));
    EXPECT_NEAR(std::asin(ray.direction.x()), std::asin(std::sin(in_air) / 1.33), 1e-9);
    const double in_glass = std::asin(std::sin(in_air) / port.window_index);
    EXPECT_NEAR(ray.origin.x(),
                port.pupil_distance_mm * std::tan(in_air) + port.window_thickness_mm * std::tan(in_glass),
                1e-9);
  }
}

TEST(TwinPort, MiddleOfThePictureLooksAsWithoutPort) {
  PortOptions port;
  port.refraction = true;
  LensNumbers numbers;
  numbers.distortion = {};
  const ViewRay with = ViewRays(numbers, port, 1.33).at(numbers.cx + 5, numbers.cy);
  const ViewRay without = ViewRays(numbers, {}, 1.33).at(numbers.cx + 5, numbers.cy);
  const auto at_15mm = [](const ViewRay& ray) {
    return Vector3d(ray.origin + ray.direction * ((15 - ray.origin.z()) / ray.direction.z()));
  };
  EXPECT_NEAR((at_15mm(with) - at_15mm(without)).norm(), 0, 2e-4);
}

}  // namespace
}  // namespace linescope::twin
