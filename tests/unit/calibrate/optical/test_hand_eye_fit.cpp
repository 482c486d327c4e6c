#include <gmock/gmock.h>

#include "common/units.hpp"
#include "tests/unit/calibrate/optical/virtual_board.hpp"
#include "tools/calibrate/hand_eye_fit.hpp"
#include "tools/calibrate/tracker_opinion.hpp"

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

/// The camera that would be calibrated from mirrored pictures.
CameraModel mirrored(CameraModel camera) {
  camera.cx = camera.width - 1 - camera.cx;
  camera.distortion[3] = -camera.distortion[3];
  return camera;
}

Session mirrored(Session session, const VirtualInstrument& instrument) {
  const int columns = instrument.board.corners_x;
  for (Observation& seen : session.observations) {
    for (cv::Point2f& p : seen.board.pixels) p.x = static_cast<float>(instrument.camera.width - 1) - p.x;
    // The finder sees a chessboard like any other and numbers its rows from the other end.
    for (int& id : seen.board.ids) id = id / columns * columns + columns - 1 - id % columns;
  }
  return session;
}

TEST(HandEyeFit, MirroredPicturesAreRecognised) {
  const Rig s;
  const Session session = mirrored(moved_about(s, 6, 25), s.instrument);
  const auto found = fit_hand_eye(session, s.instrument.board, mirrored(s.instrument.camera), 0, {});
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

/// The board on the object's sensor, and the object carried about while the pictures are taken.
Session board_on_moving_object(const Rig& s, unsigned seed, int pictures) {
  Session session = moved_about(s, seed, pictures);
  std::mt19937 dice(seed + 1000);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto any = [&](double size) {
    return Eigen::Vector3d(size * unit(dice), size * unit(dice), size * unit(dice));
  };
  for (PoseSample& endoscope : session.poses[0]) {
    // So far "world" is where the board rests: now it is the object's sensor, at a place of its own every
    // time.
    const Rigid<World, World> moved(quaternion_from_vector(any(0.8)),
                                    Eigen::Vector3d(250, 30, -40) + any(60));
    PoseSample object = endoscope;
    object.station = 1;
    object.world_from_sensor = {moved.rotation(), moved.translation()};
    endoscope.world_from_sensor = moved * endoscope.world_from_sensor;
    session.poses[1].push_back(object);
  }
  return session;
}

TEST(HandEyeFit, ABoardOnTheObjectMayBeCarriedAbout) {
  const Rig s;
  const Session session = board_on_moving_object(s, 1, 25);
  HandEyeOptions on_object;
  on_object.board_on = BoardFixedTo::object;
  const auto found = fit(s, session, on_object);
  ASSERT_TRUE(found.has_value()) << found.error().message;
  EXPECT_FALSE(found->refused) << found->refused->message;
  EXPECT_LT((found->endoscope_from_camera.translation() - s.endoscope_from_camera.translation()).norm(), 0.5);
  EXPECT_LT(found->endoscope_from_camera.rotation().angularDistance(s.endoscope_from_camera.rotation()),
            radians_from_degrees(0.1));
  EXPECT_LT((found->base_from_board.translation() - s.world_from_board.translation()).norm(), 0.5);
  // The same noise, the board at rest: carrying it about changes nothing.
  const auto at_rest = fit(s, moved_about(s, 1, 25));
  ASSERT_TRUE(at_rest.has_value());
  EXPECT_LT(
      (found->endoscope_from_camera.translation() - at_rest->endoscope_from_camera.translation()).norm(),
      1e-4);
  // Taken as fixed in the room, the same pictures contradict each other.
  const auto in_room = fit(s, session);
  EXPECT_TRUE(!in_room.has_value() || in_room->refused);
}

TEST(HandEyeFit, ALostObjectSensorIsNamed) {
  const Rig s;
  Session session = board_on_moving_object(s, 9, 20);
  for (PoseSample& object : session.poses[1]) object.state = ToolState::out_of_view;
  HandEyeOptions on_object;
  on_object.board_on = BoardFixedTo::object;
  const auto found = fit(s, session, on_object);
  ASSERT_FALSE(found.has_value());
  EXPECT_EQ(found.error().code, ErrorCode::too_few);
  EXPECT_THAT(found.error().message, HasSubstr("no pose of the object"));
}

Outcome asked(const Session& session, const BoardOptions& board, const CameraModel& camera) {
  Outcome outcome;
  ask_tracker(outcome, session, board, camera, 0);
  return outcome;
}

TEST(AskTracker, ABoardOfTheRightSizeIsConfirmed) {
  const Rig s;
  const Outcome outcome = asked(moved_about(s, 10, 25), s.instrument.board, s.instrument.camera);
  EXPECT_FALSE(outcome.refused) << outcome.refused->message;
  ASSERT_EQ(outcome.quality.parameters.size(), 1u);
  const Figure& scale = outcome.quality.parameters[0];
  EXPECT_NEAR(scale.value, 1, 4 * scale.deviation);
}

TEST(AskTracker, AWrongSquareIsFoundHoweverLarge) {
  const Rig s;
  for (const double factor : {0.94, 1.06, 2.0}) {
    BoardOptions wrong = s.instrument.board;
    wrong.square_mm *= factor;
    const Outcome outcome = asked(moved_about(s, 11, 25), wrong, s.instrument.camera);
    ASSERT_TRUE(outcome.refused) << factor;
    EXPECT_EQ(outcome.refused->code, ErrorCode::above_limit);
    EXPECT_THAT(outcome.refused->message, HasSubstr("by the tracker the board's squares measure 1."))
        << factor;
  }
}

TEST(AskTracker, AMirroredChessboardIsFound) {
  const Rig s;
  const Outcome outcome = asked(mirrored(moved_about(s, 12, 25), s.instrument), s.instrument.board,
                                mirrored(s.instrument.camera));
  ASSERT_TRUE(outcome.refused);
  EXPECT_THAT(outcome.refused->message, HasSubstr("the pictures are mirrored"));
}

TEST(AskTracker, WithoutPosesNothingIsSaidAndWithUselessOnesWhy) {
  Rig s;
  Session session = moved_about(s, 13, 25);
  std::reverse(session.observations.begin(),
               session.observations.end());  // another motion than the tracker's
  for (std::size_t i = 0; i < session.observations.size(); ++i)
    session.observations[i].time = session.poses[0][i].time;
  const Outcome other = asked(session, s.instrument.board, s.instrument.camera);
  EXPECT_FALSE(other.refused);
  ASSERT_EQ(other.quality.remarks.size(), 1u);
  EXPECT_THAT(other.quality.remarks[0], HasSubstr("do not belong together"));
  const Outcome few = asked(moved_about(s, 13, 5), s.instrument.board, s.instrument.camera);
  ASSERT_EQ(few.quality.remarks.size(), 1u);
  EXPECT_THAT(few.quality.remarks[0], HasSubstr("5 pictures have a pose, 8 are needed"));
  s.one_axis = true;
  const Outcome one_axis = asked(moved_about(s, 13, 20), s.instrument.board, s.instrument.camera);
  EXPECT_FALSE(one_axis.refused);
  ASSERT_EQ(one_axis.quality.remarks.size(), 1u);
  EXPECT_THAT(one_axis.quality.remarks[0], HasSubstr("about a second axis"));
  session.poses[0].clear();
  const Outcome none = asked(session, s.instrument.board, s.instrument.camera);
  EXPECT_TRUE(none.quality.remarks.empty());
  EXPECT_TRUE(none.quality.parameters.empty());
}

TEST(HandEyeFit, StatedDeviationsMatchTheSpreadOverHundredSeeds) {
  const Rig s;
  HandEyeOptions options;
  options.weights = HandEyeWeights::tracker;
  options.outlier_factor = 100;
  const std::vector<std::string> figures{
      "x", "y", "z", "turn about x", "turn about z", "tracker's mm per board's mm"};
  testing::expect_stated_deviations_hold(figures, [&](unsigned seed) {
    return testing::quality_in(fit(s, moved_about(s, 100 + seed, 12), options));
  });
}

}  // namespace
}  // namespace linescope::calibrate
