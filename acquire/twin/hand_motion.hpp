// Where the operator holds endoscope and harvester at any instant. A closed form of time: smooth, seeded,
// random access.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "acquire/twin/calibration_motion.hpp"
#include "acquire/twin/phantom.hpp"
#include "acquire/twin/site_profile.hpp"
#include "acquire/twin/timeline.hpp"
#include "acquire/twin/tremor.hpp"
#include "acquire/twin/twin_options.hpp"
#include "common/rigid_transform.hpp"

namespace linescope::twin {

struct SpotOnPhantom {
  Eigen::Vector3d position;
  Eigen::Vector3d normal;
};

class HandMotion {
 public:
  HandMotion(const TwinOptions& options, const Phantom& phantom);

  /// Camera against the resting phantom. `seconds` since the beginning.
  Rigid<PhantomFrame, CameraCv> phantom_from_camera(double seconds) const;

  /// The harvester against the phantom; it follows the phantom when that moves.
  HarvesterHold harvester(double seconds) const;

  Moment moment(double seconds) const { return timeline_.at(seconds); }

  const std::vector<SpotOnPhantom>& spots() const { return spots_; }

 private:
  Rigid<PhantomFrame, CameraCv> over_site(double way, double gap) const;
  Rigid<PhantomFrame, CameraCv> planned_camera(const Moment& moment, double seconds) const;
  double sweep_position(double sweep_seconds) const;
  double gap_at(double seconds) const;
  HarvesterHold on_spot(int spot, double tilt) const;
  HarvesterHold planned_harvester(const Moment& moment) const;
  HarvesterHold hovering(int spot) const;

  TwinOptions options_;
  Timeline timeline_;
  SiteProfile profile_;
  CalibrationMotion calibration_;
  std::vector<SpotOnPhantom> spots_;
  std::vector<double> tilt_azimuth_;
  Tremor position_tremor_, rotation_tremor_, tip_tremor_, axis_tremor_;
  double gap_phase_;
  double line_ahead_mm_;  ///< how far the line runs from the optical axis at the mean gap
};

}  // namespace linescope::twin
