// The laser's surface from pictures of its line on a board: a plane, or a bent form when the pictures that
// were left out say that it is closer to the truth.
#pragma once

#include "common/laser_plane.hpp"
#include "tools/calibrate/laser_points.hpp"
#include "tools/calibrate/sheet_fit.hpp"
#include "tools/calibrate/verdict.hpp"

namespace linescope::calibrate {

enum class LaserModel {
  automatic,  ///< bent when its held-out error is lower by more than chance
  plane,
  bent,  ///< always; with cubic terms when these lower the held-out error by more than chance
};

struct LaserFitOptions {
  LaserModel model = LaserModel::automatic;
  int min_pictures = 6;
  double min_depth_span = 0.1;    ///< farthest less nearest picture over the middle depth
  double max_residual_mm = 0.25;  ///< RMS distance of the points
  double max_held_out_mm = 0.35;  ///< the same on pictures that were in no fit
  double max_plane_sd_mm = 0.25;  ///< uncertainty of the surface within the depths seen, at its worst place
  double design_baseline_mm = 0;  ///< b as built, to find a wrong square size; 0: not known
  double max_scale_error = 0.1;   ///< of b against the design
  LaserPointOptions points;
  SheetFitOptions sheet;
};
Result<void> validate(const LaserFitOptions& options);

struct LaserFit {
  LaserPlane plane;  ///< the best plane, whatever the form
  Sheet sheet;       ///< in the form chosen
  SheetForm form = SheetForm::plane;
  double plane_loss_mm =
      0;            ///< held-out RMS of the plane less that of the form chosen; positive: the plane loses
  Quality quality;  ///< mm
  std::optional<Error> refused;
  std::vector<LaserPicture> pictures;  ///< in the fit
};

/// `camera`: as calibrated, for the same pictures' size.
Result<LaserFit> fit_laser(const Session& session, const BoardOptions& board, const CameraModel& camera,
                           const LaserFitOptions& options);

}  // namespace linescope::calibrate
