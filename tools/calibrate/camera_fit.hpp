// The camera from pictures of a board: OpenCV's calibrateCamera, with outliers taken out by name, an error on
// corners that were in no fit, and the three refusals.
#pragma once

#include "common/camera_model.hpp"
#include "tools/calibrate/session.hpp"
#include "tools/calibrate/verdict.hpp"

namespace linescope::calibrate {

struct CameraFitOptions {
  int coefficients = 4;        ///< 4: k1 k2 p1 p2, the thesis's; 5: and k3
  int min_pictures = 6;        ///< the thesis calibrates from six
  int min_corners = 12;        ///< per picture; with fewer it is left out
  double min_tilt_deg = 15;    ///< between the two board directions furthest apart
  double min_coverage = 0.3;   ///< of the picture's 8 by 6 cells
  double max_focal_sd = 0.01;  ///< standard deviation of the focal length over the focal length
  double max_rms_px = 0.6;     ///< residual
  double max_held_out_px = 0.9;
  int folds = 12;  ///< groups of pictures left out in turn for the held-out error; at most one each
  double outlier_factor = 3;  ///< a picture whose RMS is this many times the median is left out
};
Result<void> validate(const CameraFitOptions& options);

struct CameraFit {
  CameraModel camera;
  Quality quality;                            ///< residual and held_out in px
  std::optional<Error> refused;               ///< error_above_limit: a camera is there, and not to be used
  std::vector<std::size_t> used;              ///< elements of Session::observations
  std::vector<Rigid<CameraCv, Board>> poses;  ///< of those
};

/// Refusals too_few and too_little_variation come as failures, with the figures in the sentence.
Result<CameraFit> fit_camera(const Session& session, const BoardOptions& board,
                             const CameraFitOptions& options);

/// What the views seen so far cover.
struct Coverage {
  std::size_t pictures = 0;
  double cells = 0;  ///< fraction of the picture's 8 by 6 cells in which corners lie
  static constexpr int kAcross = 8, kDown = 6;
};
Coverage coverage_of(const Session& session);

}  // namespace linescope::calibrate
