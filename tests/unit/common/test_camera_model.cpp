#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <opencv2/calib3d.hpp>
#include <random>

#include "common/calibration.hpp"
#include "common/camera_model.hpp"

namespace linescope {
namespace {

using ::testing::HasSubstr;

cv::Mat matrix_of(const CameraModel& c) {
  return (cv::Mat_<double>(3, 3) << c.fx, c.skew, c.cx, 0, c.fy, c.cy, 0, 0, 1);
}
cv::Mat distortion_of(const CameraModel& c) {
  return cv::Mat(1, 5, CV_64F, const_cast<double*>(c.distortion.data())).clone();
}

struct Named {
  const char* name;
  CameraModel camera;
  double reach;  ///< half width of normalised directions within which the distortion can be inverted
};

class Cameras : public ::testing::TestWithParam<Named> {};

TEST_P(Cameras, ProjectsWhereOpenCvProjects) {
  const CameraModel& camera = GetParam().camera;
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> place(-GetParam().reach, GetParam().reach), depth(5, 100);
  std::vector<cv::Point3d> points;
  for (int i = 0; i < 500; ++i) {
    const double z = depth(generator);
    points.emplace_back(place(generator) * z, place(generator) * z, z);
  }
  std::vector<cv::Point2d> pixels;
  cv::projectPoints(points, cv::Vec3d(0, 0, 0), cv::Vec3d(0, 0, 0), matrix_of(camera), distortion_of(camera),
                    pixels);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d p = camera.project({points[i].x, points[i].y, points[i].z});
    EXPECT_NEAR(p.x(), pixels[i].x, 1e-9);
    EXPECT_NEAR(p.y(), pixels[i].y, 1e-9);
  }
}

TEST_P(Cameras, UndistortsWhereOpenCvUndistorts) {
  const CameraModel& camera = GetParam().camera;
  std::mt19937 generator(2);
  std::uniform_real_distribution<double> place(-GetParam().reach, GetParam().reach);
  std::vector<cv::Point2d> pixels, rays;
  std::vector<Eigen::Vector2d> truth;
  for (int i = 0; i < 500; ++i) {
    truth.emplace_back(place(generator), place(generator));
    const Eigen::Vector2d p = camera.pixel_from_normalised(truth.back());
    pixels.emplace_back(p.x(), p.y());
  }
  cv::undistortPoints(pixels, rays, matrix_of(camera), distortion_of(camera), cv::noArray(), cv::noArray(),
                      cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 500, 1e-15));
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const Eigen::Vector2d ray = camera.normalised_from_pixel({pixels[i].x, pixels[i].y});
    EXPECT_LT((ray - truth[i]).norm(), 1e-10) << "back to " << truth[i].transpose();
    // OpenCV's fixed-point iteration ends at its own accuracy.
    EXPECT_LT((ray - Eigen::Vector2d(rays[i].x, rays[i].y)).norm(), 1e-6);
  }
}

// The printed distortions are strong: camera II bends back on itself at 0.68 of the focal length, and its
// tangential terms skew it further; beyond `reach` no single direction belongs to a pixel.
INSTANTIATE_TEST_SUITE_P(
    Kinds, Cameras,
    ::testing::Values(
        Named{"ThesisCameraI", thesis_camera_i().camera, 0.3},
        Named{"ThesisCameraII", thesis_camera_ii().camera, 0.45},
        Named{"Ideal", CameraModel{640, 480, 500, 500, 0, 320, 240, {}}, 0.7},
        Named{"Barrel", CameraModel{640, 480, 500, 510, 0, 300, 250, {-0.3, 0.1, 1e-3, -2e-3, -0.02}}, 0.6},
        Named{
            "Miniature",
            CameraModel{640, 480, 643.13, 642.59, 0, 316.2, 248.1, {0.1288, -0.7222, 0.0032, -0.0009, 0.83}},
            0.5}),
    [](const auto& i) { return std::string(i.param.name); });

TEST(CameraModel, SkewIsWhatTheMatrixSays) {
  const CameraModel camera{640, 480, 500, 510, 3.5, 300, 250, {-0.2, 0.05, 1e-3, 0, 0}};
  const Eigen::Vector2d flat(0.2, -0.3);
  CameraModel straight = camera;
  straight.skew = 0;
  const Eigen::Vector2d difference =
      camera.pixel_from_normalised(flat) - straight.pixel_from_normalised(flat);
  EXPECT_NEAR(difference.x(), 3.5 * (straight.pixel_from_normalised(flat).y() - 250) / 510, 1e-9);
  EXPECT_DOUBLE_EQ(difference.y(), 0);
  EXPECT_LT((camera.normalised_from_pixel(camera.pixel_from_normalised(flat)) - flat).norm(), 1e-10);
}

TEST(CameraModel, WhereTheDistortionFoldsBackThereIsNoDirection) {
  const CameraModel camera{640, 480, 500, 500, 0, 320, 240, {-0.38, 0, 0, 0, 0}};
  // r (1 - 0.38 r^2) is largest, 0.624, at r = 0.937: no direction reaches 0.63 f from the principal point.
  EXPECT_TRUE(camera.normalised_from_pixel({320 + 500 * 0.62, 240}).allFinite());
  EXPECT_FALSE(camera.normalised_from_pixel({320 + 500 * 0.63, 240}).allFinite());
}

TEST(CameraModel, NeverJumpsAcrossTheFold) {
  // Beyond the fold the printed camera II comes back: a direction there may well project into the picture,
  // but it is not the one that the pixel saw. Whatever is returned must be reachable from the axis without
  // crossing the fold.
  for (const CameraModel& camera : {thesis_camera_i().camera, thesis_camera_ii().camera,
                                    CameraModel{640, 480, 300, 300, 0, 320, 240, {-0.5, 0.12, 0, 0, 0.02}}}) {
    for (int v = 0; v < camera.height; v += 16) {
      for (int u = 0; u < camera.width; u += 16) {
        const Eigen::Vector2d ray = camera.normalised_from_pixel({u, v});
        if (!ray.allFinite() || ray.isZero(1e-12)) continue;  // the axis itself is reached by nothing
        EXPECT_LT((camera.pixel_from_normalised(ray) - Eigen::Vector2d(u, v)).norm(), 1e-6);
        double before = -1;
        for (int i = 0; i <= 50; ++i) {
          const double part = i / 50.0;
          const double out =
              (camera.pixel_from_normalised(part * ray) - camera.pixel_from_normalised({0, 0})).norm();
          EXPECT_GT(out, before) << "pixel " << u << ", " << v << " at " << part << " of the way";
          before = out;
        }
      }
    }
  }
}

TEST(CameraModel, ScalesToAnotherPictureSize) {
  const CameraModel camera = thesis_camera_ii().camera, half = camera.scaled_to(360, 240);
  EXPECT_EQ(half.width, 360);
  const Eigen::Vector2d ray(0.1, -0.2), full = camera.pixel_from_normalised(ray),
                                        small = half.pixel_from_normalised(ray);
  // Two pixels become one; its centre lies between theirs.
  EXPECT_NEAR(small.x(), (full.x() + 0.5) / 2 - 0.5, 1e-9);
  EXPECT_NEAR(small.y(), (full.y() + 0.5) / 2 - 0.5, 1e-9);
}

struct Fault {
  const char* name;
  std::function<void(CameraModel&)> spoil;
  const char* says;
};

class ImpossibleCamera : public ::testing::TestWithParam<Fault> {};

TEST_P(ImpossibleCamera, IsRefusedInOneSentence) {
  CameraModel camera = thesis_camera_ii().camera;
  ASSERT_TRUE(validate(camera));
  GetParam().spoil(camera);
  const auto result = validate(camera);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::invalid);
  EXPECT_THAT(result.error().message, HasSubstr(GetParam().says));
}

INSTANTIATE_TEST_SUITE_P(
    Each, ImpossibleCamera,
    ::testing::Values(Fault{"Singular", [](auto& c) { c.fy = 0; }, "singular"},
                      Fault{"Millimetres", [](auto& c) { c.fx = c.fy = 0.6; }, "pixels"},
                      Fault{"Negative", [](auto& c) { c.fx = -600; }, "pixels"},
                      Fault{"NotANumber", [](auto& c) { c.distortion[2] = std::nan(""); }, "not finite"},
                      Fault{"PrincipalPoint", [](auto& c) { c.cx = 1000; }, "outside"},
                      Fault{"NoSize", [](auto& c) { c.width = 0; }, "picture size"}),
    [](const auto& i) { return std::string(i.param.name); });

}  // namespace
}  // namespace linescope
