// endoscope_from_camera from pictures of a board that stays where it is (in the world, or on sensor 2) while
// the tracked endoscope moves: OpenCV's calibrateHandEye in all its methods, then a joint least squares over
// all pictures that knows how well each board pose and each tracker pose is known.
#pragma once

#include "common/camera_model.hpp"
#include "tools/calibrate/session.hpp"
#include "tools/calibrate/verdict.hpp"

namespace linescope::calibrate {

struct Base {};  ///< where the board is fixed: the world, or the object's sensor

enum class BoardFixedTo { world, object };

/// What the joint fit makes small.
enum class HandEyeWeights {
  automatic,  ///< the one of the two with the smaller error on pictures that were in no fit
  tracker,    ///< misfits over what tracker noise and corner noise explain: electromagnetic trackers
  corners,    ///< distances of the board's corners in space: poses that are better than the camera (robots)
};

struct HandEyeOptions {
  BoardFixedTo board_on = BoardFixedTo::world;
  HandEyeWeights weights = HandEyeWeights::automatic;
  int min_pictures = 8;
  double min_rotation_deg = 8;  ///< RMS turn about the second axis: with one axis only, no lever can be found
  double max_board_px = 1.0;    ///< RMS of the board's corners; a picture above is left out
  double max_residual_mm = 1.5;  ///< RMS distance of the board's corners
  double max_held_out_mm = 2.0;
  double max_scale_error = 0.01;  ///< size of the board's squares against the tracker's millimetres
  double outlier_factor = 4;      ///< a picture whose error is this many times the median is left out
  double longest_gap_ms = 50;     ///< between two tracker samples around a picture
};
Result<void> validate(const HandEyeOptions& options);

/// One picture: where the board and the endoscope were.
struct HandEyePicture {
  std::string name;
  Rigid<CameraCv, Board> camera_from_board;
  Rigid<Base, Endoscope> base_from_endoscope;
  Eigen::Matrix<double, 6, 6> board_covariance;  ///< for corner noise of one pixel, see board_pose.hpp
  double rms_px = 0;
};

struct HandEyeFit {
  Rigid<Endoscope, CameraCv> endoscope_from_camera;
  Rigid<Base, Board> base_from_board;
  HandEyeWeights weights = HandEyeWeights::tracker;  ///< the choice made
  Quality quality;                                   ///< mm
  std::optional<Error> refused;
  std::vector<HandEyePicture> pictures;                 ///< those of the fit
  std::vector<std::pair<std::string, double>> methods;  ///< OpenCV's methods by name: RMS of the corners, mm
  /// Eq 4.9's special case, camera and sensor in parallel: L_r and the RMS it leaves, mm.
  Eigen::Vector3d parallel_lever{0, 0, 0};
  double parallel_rms_mm = kUnknown;
  double tracker_noise_mm = 0;   ///< per axis, as the fit finds it
  double tracker_noise_rad = 0;  ///< per axis
};

/// The pictures with a board, a good view of it and poses on both sides in time; `left_out` gets the others.
std::vector<HandEyePicture> hand_eye_pictures(const Session& session, const BoardOptions& board,
                                              const CameraModel& camera, Nanoseconds latency,
                                              const HandEyeOptions& options, std::vector<LeftOut>& left_out);

/// `camera` and `latency` as calibrated.
Result<HandEyeFit> fit_hand_eye(const Session& session, const BoardOptions& board, const CameraModel& camera,
                                Nanoseconds latency, const HandEyeOptions& options);

}  // namespace linescope::calibrate
