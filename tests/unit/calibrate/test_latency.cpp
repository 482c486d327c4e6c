// The latency between camera and tracker: found in noise with a true standard deviation, refused where it
// cannot be known. Poses and corners come from closed forms and a pinhole written out here.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tools/calibrate/latency_fit.hpp"
#include "tools/calibrate/turn_correlation.hpp"

namespace linescope::calibrate {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;
using testing::HasSubstr;

constexpr double kPeriod = 1 / 30.0, kTrackerPeriod = 1 / 240.0;

struct Film {
  int pictures = 120;
  double latency_ms = 23.4;
  double corner_noise_px = 0.05;
  double position_noise_mm = 0.02, rotation_noise_rad = 0.00017;
  double speed = 1;         ///< of the motion
  bool regular = false;     ///< one tone only: it repeats itself
  bool other_tool = false;  ///< the poses are those of a tool that moves otherwise
  unsigned seed = 1;
};

double tone(double hertz, double t, double phase) {
  return std::sin(2 * M_PI * hertz * t + phase);
}

Rigid<World, CameraCv> camera_at(const Film& film, double seconds) {
  const double t = film.speed * seconds;
  Vector3d turn(0.06 * tone(0.71, t, 0), 0.06 * tone(0.93, t, 2), 0.08 * tone(1.19, t, 1));
  turn += Vector3d(0.03 * tone(1.63, t, 1), 0.03 * tone(1.37, t, 0), 0.06 * tone(0.57, t, 2));
  if (film.regular) turn = Vector3d(0, 0, 0.2 * tone(8, t, 0));
  const Eigen::Quaterniond q = AngleAxisd(turn.x(), Vector3d::UnitX()) *
                               AngleAxisd(turn.y(), Vector3d::UnitY()) *
                               AngleAxisd(turn.z(), Vector3d::UnitZ());
  const Vector3d shift(tone(0.61, t, 1), 0.6 * tone(0.83, t, 0), 1.2 * tone(0.43, t, 2));
  return {Eigen::Quaterniond(AngleAxisd(0.25, Vector3d(1, 1, 0).normalized())) * q,
          Vector3d(300, 20, -40) + shift};
}

Rigid<World, Board> board_place() {
  const Film film;
  const auto middle = Rigid<World, CameraCv>(
      Eigen::Quaterniond(AngleAxisd(0.25, Vector3d(1, 1, 0).normalized())), Vector3d(300, 20, -40));
  return middle *
         Rigid<CameraCv, Board>(Eigen::Quaterniond(AngleAxisd(0.4, Vector3d(0.3, 1, 0.2).normalized())),
                                Vector3d(-4, -2.5, 17));
}

Rigid<Endoscope, CameraCv> mounting() {
  return {Eigen::Quaterniond(AngleAxisd(1.1, Vector3d(0.2, 0.9, -0.3).normalized())), Vector3d(12, -140, 40)};
}

Calibration pinhole() {
  Calibration c;
  c.camera = {360, 240, 305, 305, 0, 179.5, 119.5, {}};
  c.endoscope_from_camera = mounting();
  return c;
}

BoardOptions board() {
  BoardOptions options;
  options.square_mm = 1;
  return options;
}

struct Filmed {
  std::vector<TimedBoardView> views;
  std::vector<PoseSample> poses;
};

class Filming {
 public:
  explicit Filming(const Film& film) : film_(film), engine_(film.seed) {}

  Filmed run() {
    Filmed filmed;
    for (int i = 0; i < film_.pictures; ++i) filmed.views.push_back(picture(i));
    const int samples = static_cast<int>((film_.pictures * kPeriod + 1) / kTrackerPeriod);
    for (int i = 0; i < samples; ++i) filmed.poses.push_back(sample(i));
    return filmed;
  }

 private:
  static constexpr double kFirst = 0.4;  // s, so that there are poses before the first picture

  TimedBoardView picture(int index) {
    const double t = kFirst + index * kPeriod;
    const auto camera_from_board = camera_at(film_, t).inverse() * board_place();
    TimedBoardView view{
        "picture " + std::to_string(index), nanoseconds_from_seconds(t + 1e-3 * film_.latency_ms), {}};
    for (int id = 0; id < 54; ++id) {
      const Vector3d p = camera_from_board * Vector3d(id % 9, id / 9, 0);
      view.view.ids.push_back(id);
      view.view.pixels.emplace_back(
          static_cast<float>(305 * p.x() / p.z() + 179.5 + film_.corner_noise_px * normal()),
          static_cast<float>(305 * p.y() / p.z() + 119.5 + film_.corner_noise_px * normal()));
    }
    return view;
  }

  PoseSample sample(int index) {
    const double t = index * kTrackerPeriod;
    Film moved = film_;
    if (film_.other_tool) moved.speed = 0.37;
    const auto pose = camera_at(moved, t) * mounting().inverse();
    const Vector3d turn = film_.rotation_noise_rad * Vector3d(normal(), normal(), normal());
    PoseSample s;
    s.time = nanoseconds_from_seconds(t);
    s.state = ToolState::ok;
    s.world_from_sensor = {
        pose.rotation() * Eigen::Quaterniond(1, turn.x() / 2, turn.y() / 2, turn.z() / 2).normalized(),
        pose.translation() + film_.position_noise_mm * Vector3d(normal(), normal(), normal())};
    return s;
  }

  double normal() { return normal_(engine_); }

  Film film_;
  std::mt19937_64 engine_;
  std::normal_distribution<double> normal_;
};

Result<LatencyFit> latency_of(const Film& film, const Calibration& before = pinhole()) {
  const Filmed filmed = Filming(film).run();
  LatencyOptions options;
  options.least_pictures = 40;
  return fit_latency(filmed.views, filmed.poses, board(), before, options);
}

TEST(Latency, ExactDataGiveTheExactLatency) {
  const auto fit = latency_of({.corner_noise_px = 0, .position_noise_mm = 0, .rotation_noise_rad = 0});
  ASSERT_TRUE(fit) << fit.error().message;
  // The motion between two samples of the tracker is taken as even.
  EXPECT_NEAR(milliseconds_from(fit->latency), 23.4, 0.01);
}

TEST(Latency, NegativeAndLargeLatenciesAreFound) {
  for (const double latency : {-35.0, 120.0}) {
    const auto fit = latency_of({.latency_ms = latency});
    ASSERT_TRUE(fit) << fit.error().message;
    EXPECT_NEAR(milliseconds_from(fit->latency), latency, 0.5);
  }
}

TEST(Latency, AWrongHandEyeDoesNotPassIntoIt) {
  Calibration wrong = pinhole();
  wrong.endoscope_from_camera = {
      mounting().rotation() * Eigen::Quaterniond(AngleAxisd(0.03, Vector3d::UnitY())),
      mounting().translation() + Vector3d(2, -1, 1)};
  const auto fit = latency_of({}, wrong);
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_NEAR(milliseconds_from(fit->latency), 23.4, 0.5);
}

TEST(Latency, StatedDeviationIsTheSpreadOverSeeds) {
  constexpr int kSeeds = 100;
  double squares = 0, stated = 0;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    const auto fit = latency_of({.pictures = 80, .seed = seed});
    ASSERT_TRUE(fit) << fit.error().message;
    squares += std::pow(milliseconds_from(fit->latency) - 23.4, 2) / kSeeds;
    stated += fit->deviation_ms * fit->deviation_ms / kSeeds;
  }
  EXPECT_NEAR(std::sqrt(stated / squares), 1, 0.3);
  EXPECT_LT(std::sqrt(squares), 1);
}

TEST(Latency, HeldOutIsNotTheResidual) {
  const auto fit = latency_of({});
  ASSERT_TRUE(fit);
  EXPECT_GT(fit->held_out, 10u);
  EXPECT_NE(fit->held_out_px, fit->residual_px);
  EXPECT_LT(fit->held_out_px, 2 * fit->residual_px);
}

TEST(Latency, AnEndoscopeThatHardlyTurnsIsRefused) {
  const auto fit = latency_of({.speed = 0.02});
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().code, ErrorCode::too_little_variation);
  EXPECT_THAT(fit.error().message, HasSubstr("deg/s"));
}

TEST(Latency, AWeakCorrelationIsRefused) {
  const auto fit = latency_of({.other_tool = true});
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().code, ErrorCode::above_limit);
  EXPECT_THAT(fit.error().message, HasSubstr("saw different motions"));
}

TEST(Latency, AMotionThatRepeatsItselfIsRefused) {
  const auto fit = latency_of({.regular = true});
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().code, ErrorCode::too_little_variation);
  EXPECT_THAT(fit.error().message, HasSubstr("repeats itself"));
}

TEST(Latency, FewPicturesAndAHiddenSensorAreRefused) {
  const auto few = latency_of({.pictures = 20});
  ASSERT_FALSE(few);
  EXPECT_EQ(few.error().code, ErrorCode::too_few);
  Filmed filmed = Filming({}).run();
  for (PoseSample& sample : filmed.poses) sample.state = ToolState::out_of_view;
  const auto hidden = fit_latency(filmed.views, filmed.poses, board(), pinhole());
  ASSERT_FALSE(hidden);
  EXPECT_EQ(hidden.error().code, ErrorCode::too_few);
  EXPECT_THAT(hidden.error().message, HasSubstr("no good poses"));
}

TEST(TurnCorrelation, PosesAreNotInventedAcrossGaps) {
  std::vector<PoseSample> samples(3);
  for (int i = 0; i < 3; ++i) {
    samples[static_cast<std::size_t>(i)].time = i * 40 * kMillisecond + (i == 2 ? 40 * kMillisecond : 0);
    samples[static_cast<std::size_t>(i)].state = ToolState::ok;
    samples[static_cast<std::size_t>(i)].world_from_sensor = {Eigen::Quaterniond::Identity(),
                                                              Vector3d(i, 0, 0)};
  }
  const PoseTrack track(samples);
  EXPECT_NEAR(track.at(20 * kMillisecond)->translation().x(), 0.5, 1e-12);
  EXPECT_FALSE(track.at(80 * kMillisecond));  // 80 ms between the samples
  EXPECT_FALSE(track.at(-1));
  EXPECT_FALSE(track.at(kSecond));
}

}  // namespace
}  // namespace linescope::calibrate
