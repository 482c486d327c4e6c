#include <gmock/gmock.h>

#include "common/units.hpp"
#include "tests/unit/calibrate/optical/virtual_board.hpp"
#include "tools/calibrate/hand_eye_fit.hpp"

namespace linescope::calibrate {
namespace {

using testing::add_view;
using testing::empty_session;
using testing::figure;
using ::testing::HasSubstr;
using testing::view_of;
using testing::VirtualInstrument;

struct Rig {
  VirtualInstrument instrument;
  Rigid<Endoscope, CameraCv> endoscope_from_camera{quaternion_from_vector({0.3, -0.2, 1.1}), {4, -9, 150}};
  Rigid<World, Board> world_from_board{quaternion_from_vector({0.1, 2.9, 0.2}), {220, -40, 90}};
  double turn_noise = radians_from_degrees(0.05);
  double shift_noise = 0.1;  ///< mm
  double tilt = 0.5;         ///< rad
  bool one_axis = false;
};

/// The endoscope moves about a board that rests; one tracker sample at each picture's own instant.
Session moved_about(const Rig& s, unsigned seed, int pictures) {
  std::mt19937 dice(seed);
  std::normal_distribution<double> normal(0, 1);
  std::uniform_real_distribution<double> unit(-1, 1);
  Session session = empty_session(s.instrument);
  const auto noise = [&] { return Eigen::Vector3d(normal(dice), normal(dice), normal(dice)); };
  for (int k = 0; k < pictures; ++k) {
    auto camera_from_board = testing::random_board_pose(dice, s.instrument, s.tilt);
    if (s.one_axis)
      camera_from_board = {quaternion_from_vector({0, 0, unit(dice)}), camera_from_board.translation()};
    const Nanoseconds time = (k + 1) * kSecond;
    add_view(session, view_of(s.instrument, camera_from_board, dice), time);
    const Rigid<World, Endoscope> truth =
        s.world_from_board * camera_from_board.inverse() * s.endoscope_from_camera.inverse();
    PoseSample sample;
    sample.time = time;
    sample.state = ToolState::ok;
    sample.world_from_sensor = {truth.rotation() * quaternion_from_vector(s.turn_noise * noise()),
                                truth.translation() + s.shift_noise * noise()};
    session.poses[0].push_back(sample);
  }
  return session;
}

Result<HandEyeFit> fit(const Rig& s, const Session& session, HandEyeOptions options = {}) {
  return fit_hand_eye(session, s.instrument.board, s.instrument.camera, 0, options);
}

TEST(HandEyeFit, FindsTheCameraOnTheSensor) {
  const Rig s;
  const auto found = fit(s, moved_about(s, 1, 25));
  ASSERT_TRUE(found.has_value()) << found.error().message;
  EXPECT_FALSE(found->refused) << found->refused->message;
  const char* const axes[] = {"x", "y", "z"};
  for (int k = 0; k < 3; ++k) {
    const Figure& f = figure(found->quality, axes[k]);
    EXPECT_LT(std::abs(f.value - s.endoscope_from_camera.translation()(k)), 4 * f.deviation) << axes[k];
    EXPECT_LT(f.deviation, 0.2);
  }
  EXPECT_LT(found->endoscope_from_camera.rotation().angularDistance(s.endoscope_from_camera.rotation()),
            radians_from_degrees(0.1));
  EXPECT_EQ(found->methods.size(), 5U);
  EXPECT_GT(found->quality.held_out, 0);
  // The sensor is turned by more than a radian against the camera: Eq 4.9's special case cannot hold.
  EXPECT_GT(found->parallel_rms_mm, 10 * found->quality.residual);
}

TEST(HandEyeFit, ParallelSensorAndCameraAreTheThesissCase) {
  Rig s;
  s.endoscope_from_camera = {Eigen::Quaterniond::Identity(), {1, -8, 120}};
  const auto found = fit(s, moved_about(s, 2, 25));
  ASSERT_TRUE(found.has_value()) << found.error().message;
  EXPECT_LT((found->parallel_lever - s.endoscope_from_camera.translation()).norm(), 0.6);
  EXPECT_LT(found->parallel_rms_mm, 1.5);
}

TEST(HandEyeFit, TurnsAboutOneAxisAreRefused) {
  Rig s;
  s.one_axis = true;
  const auto found = fit(s, moved_about(s, 3, 20));
  ASSERT_FALSE(found.has_value());
  EXPECT_EQ(found.error().code, ErrorCode::too_little_variation);
  EXPECT_THAT(found.error().message, HasSubstr("second axis"));
}

TEST(HandEyeFit, AHiddenSensorIsRefusedAndSaidSo) {
  const Rig s;
  Session session = moved_about(s, 4, 20);
  for (PoseSample& sample : session.poses[0]) sample.state = ToolState::missing;
  const auto found = fit(s, session);
  ASSERT_FALSE(found.has_value());
  EXPECT_EQ(found.error().code, ErrorCode::too_few);
  EXPECT_THAT(found.error().message, HasSubstr("no pose of the endoscope: missing"));
}

TEST(HandEyeFit, AWrongSquareSizeIsFoundFromTheTracker) {
  Rig s;
  const Session session = moved_about(s, 5, 25);
  BoardOptions wrong = s.instrument.board;
  wrong.square_mm *= 1.05;
  const auto found = fit_hand_eye(session, wrong, s.instrument.camera, 0, {});
  ASSERT_TRUE(found.has_value()) << found.error().message;
  ASSERT_TRUE(found->refused);
  EXPECT_EQ(found->refused->code, ErrorCode::above_limit);
  EXPECT_THAT(found->refused->message, HasSubstr("by the tracker the board's squares measure"));
  const Figure& scale = figure(found->quality, "tracker's mm per board's mm");
  EXPECT_NEAR(scale.value, 1 / 1.05, 3 * scale.deviation);
  EXPECT_LT(scale.deviation, 0.015);
}

TEST(HandEyeFit, MirroredPicturesAreRecognised) {
  const Rig s;
  Session session = moved_about(s, 6, 25);
  CameraModel mirrored_camera = s.instrument.camera;
  mirrored_camera.cx = s.instrument.camera.width - 1 - mirrored_camera.cx;
  mirrored_camera.distortion[3] = -mirrored_camera.distortion[3];
  const int columns = s.instrument.board.corners_x;
  for (Observation& seen : session.observations) {
    for (cv::Point2f& p : seen.board.pixels) p.x = static_cast<float>(s.instrument.camera.width - 1) - p.x;
    // The finder sees a chessboard like any other and numbers its rows from the other end.
    for (int& id : seen.board.ids) id = id / columns * columns + columns - 1 - id % columns;
  }
  const auto found = fit_hand_eye(session, s.instrument.board, mirrored_camera, 0, {});
  ASSERT_TRUE(found.has_value()) << found.error().message;
  ASSERT_TRUE(found->refused);
  EXPECT_THAT(found->refused->message, HasSubstr("mirrored"));
}

TEST(HandEyeFit, ABoardThatLooksAlikeTurnedIsNotTaken) {
  const Rig s;
  BoardOptions alike = s.instrument.board;
  alike.corners_y = 5;
  const auto found = fit_hand_eye(moved_about(s, 7, 20), alike, s.instrument.camera, 0, {});
  ASSERT_FALSE(found.has_value());
  EXPECT_EQ(found.error().code, ErrorCode::unsupported);
}

TEST(HandEyeFit, StatedDeviationsMatchTheSpreadOverHundredSeeds) {
  const Rig s;
  HandEyeOptions options;
  options.weights = HandEyeWeights::tracker;
  options.outlier_factor = 100;
  std::vector<double> x, x_stated, z, z_stated;
  for (unsigned seed = 0; seed < 100; ++seed) {
    const auto found = fit(s, moved_about(s, 100 + seed, 12), options);
    ASSERT_TRUE(found.has_value()) << found.error().message;
    x.push_back(figure(found->quality, "x").value);
    x_stated.push_back(figure(found->quality, "x").deviation);
    z.push_back(figure(found->quality, "z").value);
    z_stated.push_back(figure(found->quality, "z").deviation);
  }
  EXPECT_NEAR(testing::rms_of_values(x_stated) / testing::spread_of(x), 1, 0.3);
  EXPECT_NEAR(testing::rms_of_values(z_stated) / testing::spread_of(z), 1, 0.3);
}

}  // namespace
}  // namespace linescope::calibrate
