// The scenes in which an instrument is calibrated: the board is where the truth says (judged by OpenCV's
// corner finder and projection), the motions are those that a calibration needs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "acquire/twin/calibration_motion.hpp"
#include "common/units.hpp"
#include "twin_fixture.hpp"

namespace linescope::twin {
namespace {

using Eigen::Vector3d;

TwinOptions board_twin(Scenario scenario = Scenario::board) {
  TwinOptions options = demo_twin();
  EXPECT_TRUE(apply_noise_preset(options, "manufacturer"));
  options.phantom = *phantom_from_name("board");
  options.hand.scenario = scenario;
  options.optics.line.brightness = 0;
  options.optics.light.led_brightness = 150;
  options.instrument.frame_rate_hz = 1 / (kViewHoldSeconds + kViewMoveSeconds);  // one picture of each view
  return options;
}

std::vector<cv::Point2f> found_corners(const cv::Mat& bgr) {
  cv::Mat grey;
  cv::cvtColor(bgr, grey, cv::COLOR_BGR2GRAY);
  std::vector<cv::Point2f> corners;
  const cv::Size inner(9, 6);
  if (!cv::findChessboardCornersSB(grey, inner, corners, cv::CALIB_CB_NORMALIZE_IMAGE)) return {};
  // The finder's own places bend with the lens; the gradients close to a corner do not.
  cv::cornerSubPix(grey, corners, {4, 4}, {-1, -1},
                   {cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 60, 1e-3});
  return corners;
}

std::vector<cv::Point2f> true_corners(const VirtualExperiment& twin, Nanoseconds time) {
  const TwinOptions& o = twin.options();
  const auto camera_from_board =
      twin.truth().world_from_camera(time).inverse() * twin.truth().world_from_board(time);
  std::vector<cv::Point3d> points;
  for (int row = 0; row < o.phantom.board.rows - 1; ++row) {
    for (int column = 0; column < o.phantom.board.columns - 1; ++column) {
      const Vector3d p = camera_from_board *
                         Vector3d(column * o.phantom.board.square_mm, row * o.phantom.board.square_mm, 0);
      points.emplace_back(p.x(), p.y(), p.z());
    }
  }
  const LensNumbers& l = o.instrument.lens;
  const cv::Matx33d k(l.fx, 0, l.cx, 0, l.fy, l.cy, 0, 0, 1);
  const std::vector<double> distortion(l.distortion.begin(), l.distortion.end());
  std::vector<cv::Point2d> pixels;
  cv::projectPoints(points, cv::Vec3d(), cv::Vec3d(), k, distortion, pixels);
  return {pixels.begin(), pixels.end()};
}

struct CornerErrors {
  int pictures = 0;
  double squares = 0, count = 0, sum_u = 0, sum_v = 0;
  double rms() const { return std::sqrt(squares / (2 * count)); }
};

void add_errors(std::vector<cv::Point2f> found, const std::vector<cv::Point2f>& truth, CornerErrors& errors) {
  // OpenCV numbers the corners from either end.
  if (cv::norm(found.front() - truth.front()) > cv::norm(found.back() - truth.front()))
    std::reverse(found.begin(), found.end());
  ++errors.pictures;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const cv::Point2f e = found[i] - truth[i];
    errors.squares += e.dot(e);
    errors.sum_u += e.x;
    errors.sum_v += e.y;
    ++errors.count;
  }
}

TEST(BoardScene, CornersAreWhereTheTruthSays) {
  const auto twin = experiment(board_twin());
  CornerErrors errors;
  for (const Frame& frame : pictures(board_twin(), kBoardViews)) {
    const auto found = found_corners(frame.bgr);
    if (found.size() == 54) add_errors(found, true_corners(*twin, frame.time), errors);
  }
  EXPECT_GE(errors.pictures, kBoardViews - 4);
  EXPECT_LT(errors.rms(), 0.06);  // px per axis: noise of the sensor and of the finder
  EXPECT_LT(std::abs(errors.sum_u / errors.count), 0.01);
  EXPECT_LT(std::abs(errors.sum_v / errors.count), 0.01);
}

TEST(BoardScene, CornerSquareIsBlackAndThePlateWhite) {
  TwinOptions options = board_twin(Scenario::still);
  const auto twin = experiment(options);
  const cv::Mat bgr = picture(options);
  const auto corners = true_corners(*twin, 0);
  const cv::Point2f right = corners[1] - corners[0], down = corners[9] - corners[0];
  const auto green = [&](float x, float y) {
    const cv::Point2f at = corners[0] + x * right + y * down;
    return static_cast<int>(bgr.at<cv::Vec3b>(cv::Point(at))[1]);
  };
  const int black = green(-0.5F, -0.5F);
  EXPECT_GT(green(0.5F, -0.5F), 3 * black);
  EXPECT_GT(green(-0.5F, 0.5F), 3 * black);
  EXPECT_LT(green(0.5F, 0.5F), 2 * black);
  EXPECT_GT(green(-1.5F, 0.5F), 3 * black);  // beside the pattern
}

TEST(BoardScene, ViewsDifferInTiltAndDistance) {
  const auto twin = experiment(board_twin());
  double nearest = 1e9, farthest = 0, most_tilt = 0;
  for (int i = 0; i < kBoardViews; ++i) {
    const auto camera = twin->truth().phantom_from_camera(
        nanoseconds_from_seconds(i * (kViewHoldSeconds + kViewMoveSeconds)));
    nearest = std::min(nearest, camera.translation().z());
    farthest = std::max(farthest, camera.translation().z());
    most_tilt = std::max(most_tilt, std::acos(-camera.rotate(Vector3d::UnitZ()).z()));
  }
  EXPECT_LT(nearest, 11);
  EXPECT_GT(farthest, 18);
  EXPECT_GT(degrees_from_radians(most_tilt), 25);
}

TEST(BoardScene, TheHandStandsStillAtEachView) {
  const CalibrationMotion motion(3, LensNumbers{}, BoardPattern{});
  const auto early = motion.views(0.01), late = motion.views(kViewHoldSeconds - 0.01);
  EXPECT_EQ(early.translation(), late.translation());
  EXPECT_GT((motion.views(kViewHoldSeconds + kViewMoveSeconds).translation() - late.translation()).norm(),
            0.5);
}

TEST(BoardScene, EverySeedShowsTheWholePattern) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const CalibrationMotion motion(seed, LensNumbers{}, BoardPattern{});
    for (int i = 0; i < kBoardViews; ++i) {
      const auto camera_from_phantom = motion.views(i * (kViewHoldSeconds + kViewMoveSeconds)).inverse();
      for (const Vector3d& corner : {Vector3d(2.5, 4, 0), {-2.5, 4, 0}, {2.5, -4, 0}, {-2.5, -4, 0}}) {
        const Vector3d p = camera_from_phantom * corner;
        EXPECT_LT(std::abs(p.x() / p.z()), 0.59);  // half the picture over the focal length
        EXPECT_LT(std::abs(p.y() / p.z()), 0.39);
      }
    }
  }
}

TEST(HarvesterScenes, PivotKeepsTheTipAndSwingsToAllSides) {
  TwinOptions options = board_twin(Scenario::pivot);
  options.instrument.harvester_tip = {-150, 20, 4};
  const auto twin = experiment(options);
  const Vector3d tip = twin->truth().world_from_harvester(0) * options.instrument.harvester_tip;
  double most = 0;
  for (Nanoseconds t = 0; t < 20 * kSecond; t += 100 * kMillisecond) {
    const auto pose = twin->truth().world_from_harvester(t);
    EXPECT_LT((pose * options.instrument.harvester_tip - tip).norm(), 0.05);  // slip in the divot
    const Vector3d axis = pose.rotate(options.instrument.harvester_axis);
    most = std::max(most, std::acos(axis.dot(twin->truth().harvester(0).axis)));
  }
  EXPECT_GT(degrees_from_radians(most), 30);
}

TEST(HarvesterScenes, SpinKeepsTheAxisAndTurnsTheTool) {
  TwinOptions options = board_twin(Scenario::spin);
  options.instrument.harvester_axis = Vector3d(0.9, 0.3, -0.3).normalized();
  const auto twin = experiment(options);
  const auto first = twin->truth().world_from_harvester(0);
  double most = 0;
  for (Nanoseconds t = 0; t < 8 * kSecond; t += 100 * kMillisecond) {
    const auto pose = twin->truth().world_from_harvester(t);
    const Vector3d axis = pose.rotate(options.instrument.harvester_axis);
    EXPECT_LT(axis.cross(first.rotate(options.instrument.harvester_axis)).norm(), radians_from_degrees(0.2));
    most = std::max(most, first.rotation().angularDistance(pose.rotation()));
  }
  EXPECT_GT(degrees_from_radians(most), 140);
}

TEST(LatencyScene, MovesFastEnoughAndKeepsThePatternInView) {
  const CalibrationMotion motion(1, LensNumbers{}, BoardPattern{});
  double squares = 0;
  constexpr int kSteps = 1000;
  for (int i = 0; i < kSteps; ++i) {
    const auto here = motion.shake(0.02 * i), next = motion.shake(0.02 * i + 0.001);
    squares += std::pow(here.rotation().angularDistance(next.rotation()) / 0.001, 2);
    const Vector3d middle = here.inverse() * Vector3d::Zero();
    EXPECT_LT(std::abs(middle.x() / middle.z()), 0.3);
    EXPECT_LT(std::abs(middle.y() / middle.z()), 0.2);
  }
  EXPECT_GT(std::sqrt(squares / kSteps), 0.3);  // rad/s
}

TEST(CalibrationNames, BoardAndSphereAreUnderstoodAndBackAgain) {
  EXPECT_EQ(name(*phantom_from_name("board")), "board-10x7-1");
  EXPECT_EQ(name(*phantom_from_name("board-12x9-2.5")), "board-12x9-2.5");
  EXPECT_EQ(name(*phantom_from_name("sphere-40")), "sphere-40");
  for (const char* wrong : {"board-", "board-10", "board-10x7", "board-10x7-", "board-10x7-1mm", "boards"}) {
    EXPECT_THAT(phantom_from_name(wrong).error().message, testing::HasSubstr("board-10x7-1")) << wrong;
  }
  EXPECT_EQ(phantom_from_name("board-2x7-1").error().code, ErrorCode::invalid);
  for (const char* scenario : {"board", "shake", "pivot", "spin"})
    EXPECT_EQ(name(*scenario_from_name(scenario)), scenario);
}

}  // namespace
}  // namespace linescope::twin
