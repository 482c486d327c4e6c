// Corners, laser points and poses of a made-up instrument, without pictures: projected by OpenCV, not by the
// code under test.
#pragma once

#include <gtest/gtest.h>

#include <opencv2/calib3d.hpp>
#include <random>

#include "tools/calibrate/rotation_vector.hpp"
#include "tools/calibrate/session.hpp"

namespace linescope::calibrate::testing {

struct VirtualInstrument {
  CameraModel camera{640, 480, 600, 603, 0, 322, 238, {-0.12, 0.05, 0.001, -0.0015, 0}};
  BoardOptions board{.kind = BoardKind::chessboard, .corners_x = 7, .corners_y = 4, .square_mm = 1.5};
  double corner_noise_px = 0.1;
};

/// A pose in which the whole board is seen: tilted by up to `tilt` (rad) about both axes of the picture.
inline Rigid<CameraCv, Board> random_board_pose(std::mt19937& dice, const VirtualInstrument& i, double tilt,
                                                double nearest = 12, double farthest = 20) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const double z = (nearest + farthest) / 2 + unit(dice) * (farthest - nearest) / 2;
  const Eigen::Quaterniond turn = quaternion_from_vector({tilt * unit(dice), tilt * unit(dice), 0}) *
                                  quaternion_from_vector({0, 0, 0.6 * unit(dice)});
  const Eigen::Vector3d middle((i.board.corners_x - 1) * i.board.square_mm / 2,
                               (i.board.corners_y - 1) * i.board.square_mm / 2, 0);
  const Eigen::Vector3d shift(0.18 * z * unit(dice), 0.14 * z * unit(dice), z);
  return {turn, shift - turn * middle};
}

/// Seen by OpenCV's camera, with normal noise on every coordinate.
inline BoardView view_of(const VirtualInstrument& i, const Rigid<CameraCv, Board>& camera_from_board,
                         std::mt19937& dice) {
  const CameraModel& c = i.camera;
  const cv::Mat k = (cv::Mat_<double>(3, 3) << c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1);
  const cv::Mat d(1, 5, CV_64F, const_cast<double*>(c.distortion.data()));
  std::vector<cv::Point3d> points;
  BoardView view;
  for (int id = 0; id < i.board.corners_x * i.board.corners_y; ++id) {
    const Eigen::Vector3d p =
        camera_from_board * Eigen::Vector3d(i.board.square_mm * (id % i.board.corners_x),
                                            i.board.square_mm * (id / i.board.corners_x), 0);
    points.emplace_back(p.x(), p.y(), p.z());
    view.ids.push_back(id);
  }
  std::vector<cv::Point2d> pixels;
  cv::projectPoints(points, cv::Vec3d(0, 0, 0), cv::Vec3d(0, 0, 0), k, d, pixels);
  std::normal_distribution<double> noise(0, 1);
  for (const cv::Point2d& p : pixels)
    view.pixels.emplace_back(static_cast<float>(p.x + i.corner_noise_px * noise(dice)),
                             static_cast<float>(p.y + i.corner_noise_px * noise(dice)));
  return view;
}

inline Session empty_session(const VirtualInstrument& i) {
  Session session;
  session.width = i.camera.width;
  session.height = i.camera.height;
  session.description = "made up";
  return session;
}

inline void add_view(Session& session, BoardView view, Nanoseconds time = 0) {
  Observation seen;
  seen.name = "picture " + std::to_string(session.observations.size());
  seen.time = time;
  seen.board = std::move(view);
  session.observations.push_back(std::move(seen));
  ++session.offered;
}

/// Spread of values about their mean.
inline double spread_of(const std::vector<double>& values) {
  double mean = 0, squares = 0;
  for (const double v : values) mean += v / static_cast<double>(values.size());
  for (const double v : values) squares += (v - mean) * (v - mean);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

inline double rms_of_values(const std::vector<double>& values) {
  double squares = 0;
  for (const double v : values) squares += v * v;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

inline const Figure& figure(const Quality& quality, const std::string& name) {
  for (const Figure& f : quality.parameters)
    if (f.name == name) return f;
  static const Figure none;
  ADD_FAILURE() << "no figure " << name;
  return none;
}

/// Over a hundred seeds the standard deviations that are stated match the spread of the values within 30 %.
/// `quality_of` gives the Result<Quality> of a seed.
template <class QualityOf>
void expect_stated_deviations_hold(const std::vector<std::string>& figures, QualityOf&& quality_of) {
  std::vector<std::vector<double>> values(figures.size()), stated(figures.size());
  for (unsigned seed = 0; seed < 100; ++seed) {
    const Result<Quality> quality = quality_of(seed);
    ASSERT_TRUE(quality.has_value()) << quality.error().message;
    for (std::size_t i = 0; i < figures.size(); ++i) {
      values[i].push_back(figure(*quality, figures[i]).value);
      stated[i].push_back(figure(*quality, figures[i]).deviation);
    }
  }
  for (std::size_t i = 0; i < figures.size(); ++i)
    EXPECT_NEAR(rms_of_values(stated[i]) / spread_of(values[i]), 1, 0.3) << figures[i];
}

/// Of the Result of a fit.
template <class Fit>
Result<Quality> quality_in(const Result<Fit>& fit) {
  if (!fit) return tl::unexpected(fit.error());
  return fit->quality;
}

}  // namespace linescope::calibrate::testing
