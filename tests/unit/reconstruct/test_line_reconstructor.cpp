#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <opencv2/calib3d.hpp>
#include <random>

#include "acquire/reconstruct/line_reconstructor.hpp"

namespace linescope {
namespace {

using ::testing::HasSubstr;

Calibration instrument(ProfileAxis axis) {
  Calibration c = thesis_camera_ii();
  c.camera = {640, 480, 520, 523, 0, 319.5, 239.5, {-0.38, 0.17, 1e-3, -5e-4, -0.03}};
  if (axis == ProfileAxis::row) c.laser.normal = {c.laser.normal.y(), 0.05, c.laser.normal.z()};
  c.laser.normal.normalize();
  c.endoscope_from_camera = {
      Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Eigen::Vector3d(3, 1, 2).normalized())), {4, 5, -6}};
  return c;
}

Rigid<World, Endoscope> some_pose() {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized())), {10, -5, 300}};
}

LineSample sample(double u, double v) {
  LineSample s;
  s.u = static_cast<float>(u);
  s.v = static_cast<float>(v);
  s.width = 2;
  s.peak = 120;
  s.snr = 30;
  return s;
}

ExtractedLine line_of(ProfileAxis axis) {
  ExtractedLine line;
  line.width = 640;
  line.height = 480;
  line.axis = axis;
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> part(0, 1);
  for (int i = 0; i < line.profiles(); ++i) {
    const double wave = 60 * std::sin(2 * std::numbers::pi * i / line.profiles()) + part(generator);
    line.samples.push_back(axis == ProfileAxis::column ? sample(i, 150 + wave) : sample(420 + wave, i));
  }
  return line;
}

class AlongAxis : public ::testing::TestWithParam<ProfileAxis> {};

TEST_P(AlongAxis, AgreesWithOpenCvAndEigen) {
  const Calibration c = instrument(GetParam());
  const ExtractedLine line = line_of(GetParam());
  const auto reconstructor = LineReconstructor::create(c, {});
  ASSERT_TRUE(reconstructor);
  ReconstructedLine out;
  ASSERT_TRUE(reconstructor->reconstruct(line, some_pose(), out));
  ASSERT_EQ(out.points.size(), line.samples.size());

  std::vector<cv::Point2d> pixels, rays;
  for (const LineSample& s : line.samples) pixels.emplace_back(s.u, s.v);
  const cv::Mat k =
      (cv::Mat_<double>(3, 3) << c.camera.fx, 0, c.camera.cx, 0, c.camera.fy, c.camera.cy, 0, 0, 1);
  const cv::Mat d(1, 5, CV_64F, const_cast<double*>(c.camera.distortion.data()));
  cv::undistortPoints(pixels, rays, k, d, cv::noArray(), cv::noArray(),
                      cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 300, 1e-14));
  const Eigen::Vector4d plane = opencv_from_laser_plane(c.laser);
  const Eigen::Isometry3d world = some_pose().isometry() * c.endoscope_from_camera.isometry();
  for (std::size_t i = 0; i < out.points.size(); ++i) {
    const Eigen::Vector3d ray(rays[i].x, rays[i].y, 1),
        expected = world * (-plane(3) / plane.head<3>().dot(ray) * ray);
    EXPECT_LT((out.points[i].position.cast<double>() - expected).cwiseAbs().maxCoeff(), 0.001)
        << "sample " << i;
    EXPECT_EQ(out.points[i].intensity, 120);
    EXPECT_EQ(out.pixels[i].x(), line.samples[i].u);
    EXPECT_EQ(out.pixels[i].y(), line.samples[i].v);
  }
}

TEST_P(AlongAxis, StatedDeviationIsThatOfManyNoisyCentres) {
  LineReconstructorOptions options;
  options.line_noise_px = 0.2;
  const auto reconstructor = LineReconstructor::create(instrument(GetParam()), options);
  ASSERT_TRUE(reconstructor);
  const bool column = GetParam() == ProfileAxis::column;
  const LineSample clean = column ? sample(200, 130.3) : sample(430.3, 130);
  // Middle of a line of sigma 2 px at a signal-to-noise ratio of 30, and 0.2 px of texture.
  const double noise_px = std::hypot(std::sqrt(2 * 2 / std::sqrt(std::numbers::pi)) / 30, 0.2);
  std::mt19937 generator(11);
  std::normal_distribution<double> noise(0, noise_px);
  ExtractedLine line;
  line.width = 640;
  line.height = 480;
  line.axis = GetParam();
  line.samples.push_back(clean);
  for (int i = 0; i < 4000; ++i) {
    line.samples.push_back(clean);
    float& place = column ? line.samples.back().v : line.samples.back().u;
    place += static_cast<float>(noise(generator));
  }
  ReconstructedLine out;
  ASSERT_TRUE(reconstructor->reconstruct(line, some_pose(), out));
  const Eigen::Vector3f view = (out.points[0].position - out.camera_in_world).normalized();
  double squares = 0;
  for (const SurfacePoint& p : out.points)
    squares += std::pow(static_cast<double>(view.dot(p.position - out.points[0].position)), 2);
  const double spread = std::sqrt(squares / 4000);
  EXPECT_NEAR(out.points[0].standard_deviation, spread, 0.05 * spread);
}

INSTANTIATE_TEST_SUITE_P(Axes, AlongAxis, ::testing::Values(ProfileAxis::column, ProfileAxis::row),
                         [](const auto& i) { return i.param == ProfileAxis::column ? "Columns" : "Rows"; });

TEST(LineReconstructor, CameraAndViewingDirectionAreInTheWorld) {
  const Calibration c = instrument(ProfileAxis::column);
  const auto reconstructor = LineReconstructor::create(c, {});
  ASSERT_TRUE(reconstructor);
  ReconstructedLine out;
  ASSERT_TRUE(reconstructor->reconstruct(line_of(ProfileAxis::column), some_pose(), out));
  const Eigen::Vector3d centre = some_pose() * c.endoscope_from_camera * Eigen::Vector3d::Zero();
  EXPECT_LT((out.camera_in_world.cast<double>() - centre).norm(), 1e-3);
  EXPECT_NEAR(out.viewing_direction.norm(), 1, 1e-5);
  Eigen::Vector3f middle = Eigen::Vector3f::Zero();
  for (const SurfacePoint& p : out.points) middle += p.position / static_cast<float>(out.points.size());
  EXPECT_GT(out.viewing_direction.dot((middle - out.camera_in_world).normalized()), 0.9999F);
}

TEST(LineReconstructor, EveryRejectedSampleIsCountedByReason) {
  Calibration c = instrument(ProfileAxis::column);
  c.camera.distortion = {-0.9, 0, 0, 0, 0};  // folds over inside the picture
  LineReconstructorOptions options;
  options.min_depth_mm = 8;
  options.max_depth_mm = 30;
  const auto reconstructor = LineReconstructor::create(c, options);
  ASSERT_TRUE(reconstructor);
  ExtractedLine line;
  line.width = 640;
  line.height = 480;
  line.samples = {sample(320, 150),           // fine
                  sample(std::nan(""), 150),  // not_finite
                  sample(0, 0),               // outside_lens: beyond the fold
                  sample(320, 479.5),         // outside_lens: beyond the picture
                  sample(320, 420),           // behind: below the horizon of the laser
                  sample(320, 300),           // too_far: beyond 30 mm
                  sample(320, 30)};           // too_near: closer than 8 mm
  ReconstructedLine out;
  ASSERT_TRUE(reconstructor->reconstruct(line, some_pose(), out));
  EXPECT_EQ(out.points.size(), 1U);
  EXPECT_EQ(out.count(NoSurface::not_finite), 1U);
  EXPECT_EQ(out.count(NoSurface::outside_lens), 2U);
  EXPECT_EQ(out.count(NoSurface::behind), 1U);
  EXPECT_EQ(out.count(NoSurface::too_far), 1U);
  EXPECT_EQ(out.count(NoSurface::too_near), 1U);
  // Counters belong to one line.
  line.samples.resize(1);
  ASSERT_TRUE(reconstructor->reconstruct(line, some_pose(), out));
  EXPECT_EQ(out.no_surface, NoSurfaceCounts{});
}

TEST(LineReconstructor, APictureOfAnotherSizeIsRefused) {
  const auto reconstructor = LineReconstructor::create(instrument(ProfileAxis::column), {});
  ASSERT_TRUE(reconstructor);
  ExtractedLine line = line_of(ProfileAxis::column);
  line.width = 320;
  ReconstructedLine out;
  out.points.resize(3);
  const auto result = reconstructor->reconstruct(line, some_pose(), out);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::mismatch);
  EXPECT_THAT(result.error().message, HasSubstr("320x480"));
  EXPECT_THAT(result.error().message, HasSubstr("640x480"));
  EXPECT_TRUE(out.points.empty());
}

TEST(LineReconstructor, APoseThatIsNotANumberIsRefused) {
  const auto reconstructor = LineReconstructor::create(instrument(ProfileAxis::column), {});
  ASSERT_TRUE(reconstructor);
  ReconstructedLine out;
  const Rigid<World, Endoscope> pose(Eigen::Quaterniond::Identity(), {0, std::nan(""), 0});
  const auto result = reconstructor->reconstruct(line_of(ProfileAxis::column), pose, out);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::invalid);
}

TEST(LineReconstructor, ImpossibleCalibrationAndOptionsAreRefused) {
  Calibration c = instrument(ProfileAxis::column);
  c.camera.fx = 0;
  EXPECT_FALSE(LineReconstructor::create(c, {}));
  LineReconstructorOptions options;
  options.max_depth_mm = options.min_depth_mm;
  EXPECT_FALSE(LineReconstructor::create(instrument(ProfileAxis::column), options));
  options = {};
  options.line_noise_px = -1;
  EXPECT_FALSE(LineReconstructor::create(instrument(ProfileAxis::column), options));
}

TEST(LineReconstructor, ReasonsHaveNames) {
  EXPECT_EQ(name(NoSurface::not_finite), "not finite");
  EXPECT_EQ(name(NoSurface::outside_lens), "outside the lens model");
  EXPECT_EQ(name(NoSurface::behind), "behind the camera");
  EXPECT_EQ(name(NoSurface::too_near), "too near");
  EXPECT_EQ(name(NoSurface::too_far), "too far");
}

}  // namespace
}  // namespace linescope
