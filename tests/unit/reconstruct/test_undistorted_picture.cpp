// The thesis undistorts the picture and then looks for the line; we look for the line and undistort its
// points. Both must end at the same ray: checked on a line drawn through OpenCV's own projection.
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>

#include "acquire/laser/line_extractor.hpp"
#include "common/calibration.hpp"

namespace linescope {
namespace {

/// A straight line in space, drawn as a Gaussian ridge of the distorted picture: dense points of the line are
/// projected, and each column's middle is interpolated between them.
cv::Mat draw(const CameraModel& camera, const cv::Mat& k, const cv::Mat& d) {
  std::vector<cv::Point3d> points;
  for (int i = -4000; i <= 4000; ++i) points.emplace_back(i * 0.006, -3.0 + 0.05 * (i * 0.006), 20.0);
  std::vector<cv::Point2d> pixels;
  cv::projectPoints(points, cv::Vec3d(0, 0, 0), cv::Vec3d(0, 0, 0), k, d, pixels);
  cv::Mat picture(camera.height, camera.width, CV_8UC3, cv::Scalar(20, 30, 20));
  std::size_t next = 1;
  for (int u = 0; u < camera.width; ++u) {
    while (next < pixels.size() && (pixels[next].x < u || pixels[next].x <= pixels[next - 1].x)) ++next;
    if (next >= pixels.size() || pixels[next - 1].x > u) continue;
    const double part = (u - pixels[next - 1].x) / (pixels[next].x - pixels[next - 1].x);
    const double centre = pixels[next - 1].y + part * (pixels[next].y - pixels[next - 1].y);
    for (int v = 0; v < camera.height; ++v) {
      const double light = 30 + 180 * std::exp(-(v - centre) * (v - centre) / (2 * 2.0 * 2.0));
      picture.at<cv::Vec3b>(v, u)[1] = cv::saturate_cast<uchar>(light);
    }
  }
  return picture;
}

TEST(Undistortion, OfThePointsAgreesWithUndistortionOfThePicture) {
  const CameraModel camera{640, 480, 560, 560, 0, 320, 240, {-0.3, 0.1, 1e-3, -1e-3, 0}};
  const cv::Mat k = (cv::Mat_<double>(3, 3) << camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
  const cv::Mat d = (cv::Mat_<double>(1, 5) << -0.3, 0.1, 1e-3, -1e-3, 0);
  const cv::Mat picture = draw(camera, k, d);
  cv::Mat straight;
  cv::undistort(picture, straight, k, d);

  LineExtractor first(LineExtractorOptions{}), second(LineExtractorOptions{});
  const ExtractedLine &bent = first.extract(picture), &unbent = second.extract(straight);
  ASSERT_GT(bent.samples.size(), 600U);
  ASSERT_GT(unbent.samples.size(), 600U);
  // On the picture's way the line is straight; our points must lie on it.
  double sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0;
  for (const LineSample& s : unbent.samples) {
    const double x = (s.u - camera.cx) / camera.fx, y = (s.v - camera.cy) / camera.fy;
    sum_x += x, sum_y += y, sum_xx += x * x, sum_xy += x * y;
  }
  const auto n = static_cast<double>(unbent.samples.size());
  const double slope = (n * sum_xy - sum_x * sum_y) / (n * sum_xx - sum_x * sum_x),
               level = (sum_y - slope * sum_x) / n;
  double squares = 0, mean = 0;
  for (const LineSample& s : bent.samples) {
    const Eigen::Vector2d ray =
        camera.normalised_from_pixel({static_cast<double>(s.u), static_cast<double>(s.v)});
    const double off = camera.fy * (ray.y() - level - slope * ray.x());
    squares += off * off;
    mean += off;
  }
  EXPECT_LT(std::abs(mean / static_cast<double>(bent.samples.size())), 0.02);
  EXPECT_LT(std::sqrt(squares / static_cast<double>(bent.samples.size())), 0.05);
}

}  // namespace
}  // namespace linescope
