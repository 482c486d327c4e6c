// The numbers of the hand-eye step: closed forms for a start, the joint least squares, and the special case.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/calibrate/hand_eye_fit.hpp"

namespace linescope::calibrate {

/// Some of the pictures, which somebody else holds.
using HandEyePictures = std::vector<const HandEyePicture*>;
HandEyePictures all_of(const std::vector<HandEyePicture>& pictures);

struct HandEyeSolution {
  Rigid<Endoscope, CameraCv> endoscope_from_camera;
  Rigid<Base, Board> base_from_board;
  double scale = 1;            ///< tracker's millimetres per millimetre of the board
  double scale_deviation = 0;  ///< standard deviation; 0: the scale was not fitted
  Eigen::Matrix<double, 6, 6>
      covariance;  ///< of endoscope_from_camera: rotation vector (rad), translation (mm)
  double tracker_noise_mm = 0, tracker_noise_rad = 0;
};

/// OpenCV's methods by name; those that fail are left out.
std::vector<std::pair<std::string, Rigid<Endoscope, CameraCv>>> closed_forms(const HandEyePictures& pictures);

/// The best of them, and how well each does (RMS of the board's corners, mm) when `methods` is given.
std::optional<HandEyeSolution> best_closed_form(
    const HandEyePictures& pictures, const BoardOptions& board,
    std::vector<std::pair<std::string, double>>* methods = nullptr);

/// Noise of the corners, px per coordinate, as the pictures' own fits show it.
double corner_noise_px(const HandEyePictures& pictures);

/// The board's place as the mean over all pictures.
Rigid<Base, Board> mean_board(const HandEyePictures& pictures,
                              const Rigid<Endoscope, CameraCv>& endoscope_from_camera);

/// Each picture's board pose is known as well as its corners are (corner_px), each tracker pose to a noise
/// that the fit estimates itself. `with_scale`: the board's size is an unknown too.
HandEyeSolution refine(const HandEyePictures& pictures, const HandEyeSolution& start, double corner_px,
                       bool with_scale);

/// The least squares of the board's corners in space, each picture alike: for poses that are better known
/// than the camera is (a robot). Leaves `covariance` unknown.
HandEyeSolution refine_corners(const HandEyePictures& pictures, const HandEyeSolution& start,
                               const BoardOptions& board);

/// RMS distance over the board's corners between where the chain puts them and where they are, mm.
double chain_error(const HandEyePicture& picture, const HandEyeSolution& solution, const BoardOptions& board);
double chain_error(const HandEyePictures& pictures, const HandEyeSolution& solution,
                   const BoardOptions& board);

/// What the picture would be had the camera looked into a mirror.
HandEyePicture unmirrored(const HandEyePicture& picture);

/// Camera and sensor in parallel: the lever L_r by linear least squares, and the RMS of the board's corners.
std::pair<Eigen::Vector3d, double> parallel_lever(const HandEyePictures& pictures, const BoardOptions& board);

/// The smaller of the two largest RMS turns about perpendicular axes, rad: zero when all turns share one
/// axis.
double second_turn(const HandEyePictures& pictures);

}  // namespace linescope::calibrate
