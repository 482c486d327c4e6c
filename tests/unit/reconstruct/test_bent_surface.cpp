// Points on a sheet that is no plane: made in space, seen by OpenCV's camera, brought back.
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/calib3d.hpp>

#include "acquire/reconstruct/laser_surface.hpp"
#include "acquire/reconstruct/line_reconstructor.hpp"

namespace linescope {
namespace {

constexpr double kBaseline = 6, kSlope = 0.25;

/// Hand over, with y down: 1/z = (slope - y + 0.23 x^2 - 0.02 x y + 0.01 y^2 + 0.03 x^3 - 0.2 x^2 y + 0.04 x
/// y^2 - 0.05 y^3) / b.
double inverse_depth(double x, double y) {
  return (kSlope - y + 0.23 * x * x - 0.02 * x * y + 0.01 * y * y + 0.03 * x * x * x - 0.2 * x * x * y +
          0.04 * x * y * y - 0.05 * y * y * y) /
         kBaseline;
}

/// The same in the calibration, whose y points up.
Calibration instrument() {
  Calibration c = thesis_camera_ii();
  c.camera = {640, 480, 520, 523, 0, 319.5, 239.5, {-0.38, 0.17, 1e-3, -5e-4, -0.03}};
  c.laser = laser_plane_from_baseline(kBaseline, std::atan(kSlope));
  c.laser_bend.b = {0.23, 0.02, 0.01, 0.03, 0.2, 0.04, 0.05};
  for (double& term : c.laser_bend.b) term /= kBaseline;
  return c;
}

ExtractedLine seen(const Calibration& c, const std::vector<cv::Point3d>& points) {
  const cv::Mat k =
      (cv::Mat_<double>(3, 3) << c.camera.fx, 0, c.camera.cx, 0, c.camera.fy, c.camera.cy, 0, 0, 1);
  const cv::Mat d(1, 5, CV_64F, const_cast<double*>(c.camera.distortion.data()));
  std::vector<cv::Point2d> pixels;
  cv::projectPoints(points, cv::Vec3d(0, 0, 0), cv::Vec3d(0, 0, 0), k, d, pixels);
  ExtractedLine line;
  line.width = 640;
  line.height = 480;
  for (const cv::Point2d& p : pixels) {
    LineSample s;
    s.u = static_cast<float>(p.x);
    s.v = static_cast<float>(p.y);
    s.width = 2;
    s.snr = 30;
    line.samples.push_back(s);
  }
  return line;
}

std::vector<cv::Point3d> points_on_the_sheet() {
  std::vector<cv::Point3d> points;
  for (double x = -0.45; x <= 0.45; x += 0.05)
    for (double y = -0.35; y <= 0.05; y += 0.05) {
      const double z = 1 / inverse_depth(x, y);
      points.emplace_back(x * z, y * z, z);
    }
  return points;
}

TEST(BentSurface, PointsInSpaceComeBack) {
  const Calibration c = instrument();
  const auto points = points_on_the_sheet();
  const auto reconstructor = LineReconstructor::create(c, {});
  ASSERT_TRUE(reconstructor) << reconstructor.error().message;
  ReconstructedLine out;
  ASSERT_TRUE(reconstructor->reconstruct(seen(c, points), {}, out));
  ASSERT_EQ(out.points.size(), points.size());
  double beside_plane = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d truth(points[i].x, points[i].y, points[i].z);
    // 0.001 mm at 9 to 30 mm: what the table of rays, linear between pixels, leaves.
    EXPECT_LT((out.points[i].position.cast<double>() - truth).norm(), 1e-3 * truth.z() / 9) << i;
    const double plane = *c.laser.depth_along(truth.x() / truth.z(), -truth.y() / truth.z());
    beside_plane = std::max(beside_plane, std::abs(plane - truth.z()));
  }
  EXPECT_GT(beside_plane, 1) << "a plane would have done";
}

/// The slopes carry noise from the picture into the depth.
TEST(BentSurface, SlopesAreThoseOfTheDepth) {
  const Calibration c = instrument();
  const BentSurface surface(c.laser, c.laser_bend);
  for (const float x : {-0.3F, 0.0F, 0.4F})
    for (const float y : {-0.3F, 0.05F}) {
      const SurfaceHit hit = surface.meet(x, y);
      const double step = 1e-6;
      const auto depth = [](double at_x, double at_y) { return 1 / inverse_depth(at_x, at_y); };
      const double by_x = (depth(x + step, y) - depth(x - step, y)) / (2 * step);
      const double by_y = (depth(x, y + step) - depth(x, y - step)) / (2 * step);
      EXPECT_NEAR(hit.depth, depth(x, y), 1e-4 * hit.depth);
      EXPECT_NEAR(hit.by_x, by_x, 1e-3 * std::abs(by_y));
      EXPECT_NEAR(hit.by_y, by_y, 1e-3 * std::abs(by_y));
    }
}

TEST(BentSurface, RaysThatDoNotMeetItAreCountedAsBesideAPlane) {
  const Calibration c = instrument();
  LineReconstructorOptions options;
  options.min_depth_mm = 10;
  options.max_depth_mm = 30;
  const auto reconstructor = LineReconstructor::create(c, options);
  ASSERT_TRUE(reconstructor);
  ExtractedLine line = seen(c, {{0, -1, 16}});
  for (const float v : {420.0F, 330.0F, 30.0F, 500.0F}) {
    line.samples.push_back(line.samples.front());
    line.samples.back().v = v;
  }
  ReconstructedLine out;
  ASSERT_TRUE(reconstructor->reconstruct(line, {}, out));
  EXPECT_EQ(out.points.size(), 1U);
  EXPECT_EQ(out.count(NoSurface::behind), 1U);
  EXPECT_EQ(out.count(NoSurface::too_far), 1U);
  EXPECT_EQ(out.count(NoSurface::too_near), 1U);
  EXPECT_EQ(out.count(NoSurface::outside_lens), 1U);
}

}  // namespace
}  // namespace linescope
