// Real pictures with published results (docs/calibrating.md).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "common/units.hpp"
#include "tests/support/shared_data.hpp"
#include "tools/calibrate/camera_fit.hpp"
#include "tools/calibrate/hand_eye_fit.hpp"
#include "tools/calibrate/inputs.hpp"
#include "tools/calibrate/laser_fit.hpp"

namespace linescope::calibrate {
namespace {

using linescope::testing::shared_data;

Session session_of(const char* folder, const BoardOptions& board,
                   std::optional<LineExtractorOptions> line = {}) {
  auto input = input_from_path(shared_data(folder));
  CollectOptions options;
  options.board = board;
  options.line = line;
  auto session = collect(*input, options);
  EXPECT_TRUE(session.has_value());
  return session.value_or(Session{});
}

CameraFitOptions five() {
  CameraFitOptions options;
  options.coefficients = 5;
  return options;
}

double deviations_off(const Quality& quality, const char* name, double published) {
  for (const Figure& f : quality.parameters)
    if (f.name == name) return std::abs(f.value - published) / f.deviation;
  return 1e9;
}

TEST(RealCalibration, CiclopAgreesWithItsPublishedCamera) {
  LINESCOPE_NEEDS_SHARED_DATA();
  const BoardOptions board{.kind = BoardKind::chessboard, .corners_x = 11, .corners_y = 6, .square_mm = 13};
  const auto fit = fit_camera(session_of("ciclop/chessboard", board), board, five());
  ASSERT_TRUE(fit.has_value()) << fit.error().message;
  EXPECT_FALSE(fit->refused);
  EXPECT_EQ(fit->quality.used, 16U);
  const std::pair<const char*, double> published[] = {{"fx", 1429.67}, {"fy", 1430.39}, {"k1", 0.0272},
                                                      {"k2", -0.2310}, {"k3", 0.5089},  {"cy", 642.60}};
  for (const auto& [name, value] : published) EXPECT_LT(deviations_off(fit->quality, name, value), 2) << name;
}

TEST(RealCalibration, TheWeakHandheldSetIsAboveTheLimitAsPublished) {
  LINESCOPE_NEEDS_SHARED_DATA();
  const BoardOptions board{.kind = BoardKind::chessboard, .corners_x = 9, .corners_y = 7, .square_mm = 10};
  const auto fit = fit_camera(session_of("handheld/chessboard", board), board, five());
  ASSERT_TRUE(fit.has_value()) << fit.error().message;
  ASSERT_TRUE(fit->refused);
  EXPECT_EQ(fit->refused->code, ErrorCode::above_limit);
  EXPECT_NEAR(fit->quality.residual, 1.68, 0.15);
}

/// All three steps from the same nineteen pictures.
TEST(RealCalibration, TheMiniatureScannerIsFoundFromItsPictures) {
  LINESCOPE_NEEDS_SHARED_DATA();
  const BoardOptions board{.kind = BoardKind::chessboard, .corners_x = 9, .corners_y = 6, .square_mm = 5};
  LineExtractorOptions line;
  line.colour = LaserColour::red;
  const Session session = session_of("miniature-scanner/frames", board, line);
  const auto camera = fit_camera(session, board, five());
  ASSERT_TRUE(camera.has_value()) << camera.error().message;
  EXPECT_FALSE(camera->refused);
  EXPECT_GE(camera->quality.used, 13U);
  EXPECT_LT(deviations_off(camera->quality, "fx", 643.129), 2);
  EXPECT_LT(deviations_off(camera->quality, "fy", 642.591), 2);
  EXPECT_LT(deviations_off(camera->quality, "cx", 316.246), 2);
  EXPECT_LT(deviations_off(camera->quality, "cy", 248.117), 2);

  LaserFitOptions laser_options;
  laser_options.points.margin_squares = 3;
  const auto laser = fit_laser(session, board, camera->camera, laser_options);
  ASSERT_TRUE(laser.has_value()) << laser.error().message;
  EXPECT_FALSE(laser->refused);
  EXPECT_LT(laser->quality.residual, 0.19);  // RMS of the published plane
  // Where the two planes meet the optical axis's neighbourhood in the middle of the depths that were seen.
  const double z = 75;
  const Eigen::Vector4d ours = opencv_from_laser_plane(laser->plane);
  const Eigen::Vector4d published(-0.0179766816532, 0.898612788841, 0.438374149155, -15.6625366311);
  const double y = -(published(2) * z + published(3)) / published(1);
  EXPECT_LT(std::abs(ours(0) * 0 + ours(1) * y + ours(2) * z + ours(3)), 0.3);

  const auto hand_eye = fit_hand_eye(session, board, camera->camera, 0, {});
  ASSERT_TRUE(hand_eye.has_value()) << hand_eye.error().message;
  EXPECT_FALSE(hand_eye->refused);
  EXPECT_LT(deviations_off(hand_eye->quality, "x", 101.421), 3);
  EXPECT_LT(deviations_off(hand_eye->quality, "y", -16.172), 3);
  EXPECT_LT(deviations_off(hand_eye->quality, "z", 0.315), 3);
  EXPECT_LT(hand_eye->quality.held_out, 0.6);
}

/// Calibration by OpenCV alone, with corners refined in a window that reaches `reach` px to each side.
struct Refined {
  cv::Mat k, d, deviations, per_picture;
  double rms = 0;
  double f() const { return k.at<double>(0, 0); }
};

Refined calibrated_with_window(int reach) {
  std::vector<std::vector<cv::Point3f>> points;
  std::vector<std::vector<cv::Point2f>> corners;
  cv::Mat picture;
  for (int i = 0; i < 12; ++i) {
    picture = cv::imread(shared_data(fmt::format("chessboards/webcam/calib.images.{}.png", i)).string(),
                         cv::IMREAD_GRAYSCALE);
    auto& found = corners.emplace_back();
    EXPECT_TRUE(cv::findChessboardCorners(
        picture, {14, 10}, found,
        cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_FILTER_QUADS));
    cv::cornerSubPix(picture, found, {reach, reach}, {-1, -1},
                     {cv::TermCriteria::EPS | cv::TermCriteria::COUNT, 30, 0.001});
    auto& board = points.emplace_back();
    for (int k = 0; k < 14 * 10; ++k)
      board.emplace_back(6.0F * static_cast<float>(k % 14), 6.0F * static_cast<float>(k / 14), 0.0F);
  }
  Refined r;
  std::vector<cv::Mat> rotations, translations;
  r.rms = cv::calibrateCamera(points, corners, picture.size(), r.k, r.d, rotations, translations,
                              r.deviations, cv::noArray(), r.per_picture);
  return r;
}

/// The published camera is what OpenCV gives when corners are refined in a window of 23 px: in pictures 10
/// and 11, where the squares are 8 to 10 px wide, half of the corners go over to their neighbours. In a
/// window of 11 px all stay, and the published 608.67 px becomes ours.
TEST(RealCalibration, TheWebcamsPublishedCameraComesFromCornersThatWentAstray) {
  LINESCOPE_NEEDS_SHARED_DATA();
  const Refined wide = calibrated_with_window(11), narrow = calibrated_with_window(5);
  const double published[] = {608.67179504, 606.13421375, 323.12263928, 231.29247171, -0.02191634,
                              -0.14300148,  -0.00395124,  -0.00044941,  0.19656551};
  const double again[] = {wide.k.at<double>(0, 0), wide.k.at<double>(1, 1), wide.k.at<double>(0, 2),
                          wide.k.at<double>(1, 2), wide.d.at<double>(0),    wide.d.at<double>(1),
                          wide.d.at<double>(2),    wide.d.at<double>(3),    wide.d.at<double>(4)};
  for (int i = 0; i < 9; ++i)
    EXPECT_LT(std::abs(again[i] - published[i]), 0.5 * wide.deviations.at<double>(i)) << i;
  for (int i = 0; i < 12; ++i) {
    const bool astray = wide.per_picture.at<double>(i) > 3;
    EXPECT_EQ(astray, i >= 10) << i << ": " << wide.per_picture.at<double>(i);
    EXPECT_LT(narrow.per_picture.at<double>(i), 0.7) << i;
  }

  const BoardOptions board{.kind = BoardKind::chessboard, .corners_x = 14, .corners_y = 10, .square_mm = 6};
  const auto fit = fit_camera(session_of("chessboards/webcam", board), board, five());
  ASSERT_TRUE(fit.has_value()) << fit.error().message;
  EXPECT_FALSE(fit->refused);
  EXPECT_EQ(fit->quality.used, 12U);
  EXPECT_LT(deviations_off(fit->quality, "fx", narrow.f()), 1);
  EXPECT_LT(deviations_off(fit->quality, "fy", narrow.k.at<double>(1, 1)), 1);
  EXPECT_GT(deviations_off(fit->quality, "fx", published[0]), 3);
  EXPECT_LT(fit->quality.held_out, 0.4);
}

}  // namespace
}  // namespace linescope::calibrate
