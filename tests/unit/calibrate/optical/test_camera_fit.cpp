#include <gmock/gmock.h>

#include "tests/unit/calibrate/optical/virtual_board.hpp"
#include "tools/calibrate/camera_fit.hpp"

namespace linescope::calibrate {
namespace {

using testing::add_view;
using testing::empty_session;
using testing::figure;
using ::testing::HasSubstr;
using testing::random_board_pose;
using testing::view_of;
using testing::VirtualInstrument;

Session session_with(const VirtualInstrument& i, unsigned seed, int pictures, double tilt) {
  std::mt19937 dice(seed);
  Session session = empty_session(i);
  for (int k = 0; k < pictures; ++k) add_view(session, view_of(i, random_board_pose(dice, i, tilt), dice));
  return session;
}

TEST(CameraFit, FindsTheCameraWithinItsStatedDeviations) {
  const VirtualInstrument i;
  const auto fit = fit_camera(session_with(i, 1, 15, 0.6), i.board, {});
  ASSERT_TRUE(fit.has_value()) << fit.error().message;
  EXPECT_FALSE(fit->refused);
  EXPECT_EQ(fit->quality.used, 15U);
  const std::pair<const char*, double> truth[] = {{"fx", i.camera.fx},
                                                  {"fy", i.camera.fy},
                                                  {"cx", i.camera.cx},
                                                  {"cy", i.camera.cy},
                                                  {"k1", i.camera.distortion[0]}};
  for (const auto& [name, value] : truth) {
    const Figure& f = figure(fit->quality, name);
    EXPECT_LT(std::abs(f.value - value), 4 * f.deviation) << name;
  }
  // Noise of 0.1 px per coordinate is 0.141 px over both; the fit's share of it is a few per cent.
  EXPECT_NEAR(fit->quality.residual, 0.141, 0.012);
  // Corners that fixed neither camera nor pose carry the pose's error on top of their own noise.
  EXPECT_GT(fit->quality.held_out, fit->quality.residual);
  EXPECT_LT(fit->quality.held_out, 2 * 0.141);
}

TEST(CameraFit, FewPicturesAreRefusedWithTheirNumber) {
  const VirtualInstrument i;
  const auto fit = fit_camera(session_with(i, 1, 4, 0.6), i.board, {});
  ASSERT_FALSE(fit.has_value());
  EXPECT_EQ(fit.error().code, ErrorCode::too_few);
  EXPECT_THAT(fit.error().message, HasSubstr("4 of 4 pictures"));
}

TEST(CameraFit, BoardsAllParallelAreRefused) {
  const VirtualInstrument i;
  const auto fit = fit_camera(session_with(i, 2, 15, 0), i.board, {});
  ASSERT_FALSE(fit.has_value());
  EXPECT_EQ(fit.error().code, ErrorCode::too_little_variation);
  EXPECT_THAT(fit.error().message, HasSubstr("Tilt"));
}

TEST(CameraFit, BoardsAllTiltedTheSameWayAreRefused) {
  const VirtualInstrument i;
  std::mt19937 dice(3);
  Session session = empty_session(i);
  const Eigen::Quaterniond turn = quaternion_from_vector({0.4, 0, 0});
  for (int k = 0; k < 12; ++k) {
    const auto pose = random_board_pose(dice, i, 0);
    add_view(session, view_of(i, {turn, pose.translation()}, dice));
  }
  const auto fit = fit_camera(session, i.board, {});
  ASSERT_FALSE(fit.has_value());
  EXPECT_EQ(fit.error().code, ErrorCode::too_little_variation);
}

TEST(CameraFit, CornersInTheMiddleOnlyAreRefused) {
  const VirtualInstrument i;
  std::mt19937 dice(4);
  Session session = empty_session(i);
  for (int k = 0; k < 20; ++k) {
    auto pose = random_board_pose(dice, i, 0.6, 60, 70);
    add_view(session, view_of(i, pose, dice));
  }
  CameraFitOptions options;
  options.max_focal_sd = 1;
  options.min_coverage = 0.6;
  const auto fit = fit_camera(session, i.board, options);
  ASSERT_FALSE(fit.has_value());
  EXPECT_EQ(fit.error().code, ErrorCode::too_little_variation);
  EXPECT_THAT(fit.error().message, HasSubstr("% of the picture"));
}

TEST(CameraFit, AnOutlierIsNamedAndLeftOut) {
  const VirtualInstrument i;
  Session session = session_with(i, 5, 12, 0.6);
  for (std::size_t k = 0; k < 6; ++k) session.observations[7].board.pixels[k] += cv::Point2f(6, -4);
  const auto fit = fit_camera(session, i.board, {});
  ASSERT_TRUE(fit.has_value()) << fit.error().message;
  ASSERT_EQ(fit->quality.left_out.size(), 1U);
  EXPECT_EQ(fit->quality.left_out[0].name, "picture 7");
  EXPECT_THAT(fit->quality.left_out[0].reason, HasSubstr("outlier"));
  EXPECT_NEAR(fit->quality.residual, 0.141, 0.015);
}

TEST(CameraFit, NoisyCornersAreAboveTheLimitAndStillShown) {
  VirtualInstrument i;
  i.corner_noise_px = 0.8;
  CameraFitOptions options;
  options.max_focal_sd = 1;
  const auto fit = fit_camera(session_with(i, 6, 12, 0.6), i.board, options);
  ASSERT_TRUE(fit.has_value()) << fit.error().message;
  ASSERT_TRUE(fit->refused);
  EXPECT_EQ(fit->refused->code, ErrorCode::above_limit);
  EXPECT_GT(fit->quality.residual, 0.6);
}

/// The promise of the calibration: what it states as deviation is what happens.
TEST(CameraFit, StatedDeviationsMatchTheSpreadOverHundredSeeds) {
  const VirtualInstrument i;
  CameraFitOptions options;
  options.max_focal_sd = 1;
  options.folds = 4;
  testing::expect_stated_deviations_hold({"fx", "cy"}, [&](unsigned seed) {
    std::mt19937 poses(77), noise(seed);
    Session session = empty_session(i);
    for (int k = 0; k < 10; ++k) add_view(session, view_of(i, random_board_pose(poses, i, 0.6), noise));
    return testing::quality_in(fit_camera(session, i.board, options));
  });
}

/// What independent corner noise cannot explain: pictures stretched by 0.2 %, each in its own way.
TEST(CameraFit, PicturesThatDisagreeAreSaidAndWidenTheDeviations) {
  VirtualInstrument i;
  i.corner_noise_px = 0.05;
  Session session = session_with(i, 8, 12, 0.6);
  std::mt19937 dice(8);
  std::normal_distribution<double> normal(0, 1);
  for (Observation& seen : session.observations) {
    const cv::Point2f stretch(static_cast<float>(0.002 * normal(dice)),
                              static_cast<float>(0.002 * normal(dice)));
    const cv::Point2f first = seen.board.pixels[0];
    for (cv::Point2f& p : seen.board.pixels)
      p += cv::Point2f((p.x - first.x) * stretch.x, (p.y - first.y) * stretch.y);
  }
  const auto fit = fit_camera(session, i.board, {});
  ASSERT_TRUE(fit.has_value()) << fit.error().message;
  ASSERT_EQ(fit->quality.remarks.size(), 1U);
  EXPECT_THAT(fit->quality.remarks[0], HasSubstr("disagree"));
  EXPECT_LT(std::abs(figure(fit->quality, "fx").value - i.camera.fx),
            4 * figure(fit->quality, "fx").deviation);
}

}  // namespace
}  // namespace linescope::calibrate
