// What really is, for tests and evaluation: never an input of acquisition or viewer.
//
// Times are CLOCK_MONOTONIC as in TwinOptions::start. Object is the frame of sensor 2; lengths are mm.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "acquire/twin/phantom.hpp"
#include "acquire/twin/twin_options.hpp"
#include "common/rigid_transform.hpp"
#include "common/time.hpp"

namespace linescope::twin {

class HandMotion;
class Stage;

/// A marked spot of the navigation experiment, in the object's frame.
struct MarkedSpot {
  Eigen::Vector3d position;
  Eigen::Vector3d normal;  ///< unit, out of the surface
};

/// Where the harvester's tip and axis really are, world frame.
struct HarvesterTruth {
  Eigen::Vector3d tip;
  Eigen::Vector3d axis;  ///< unit, from the tip to the handle
  double spin_rad = 0;   ///< turn about the axis
  int spot = -1;         ///< index of the spot it stands on, -1 while it moves between spots
  double angle_to_normal_rad =
      0;  ///< between axis and the true normal of that spot; meaningless when spot is -1
};

class TwinTruth {
 public:
  TwinTruth(const TwinOptions& options, std::shared_ptr<const Phantom> phantom);

  /// Signed distance of a point (object's frame) from the phantom's surface; positive outside.
  double distance(const Eigen::Vector3d& point_object) const;

  /// Unit normal out of the surface at the surface point nearest to `point_object`.
  Eigen::Vector3d normal(const Eigen::Vector3d& point_object) const;

  Rigid<World, Endoscope> world_from_endoscope(Nanoseconds time) const;
  Rigid<World, Object> world_from_object(Nanoseconds time) const;
  Rigid<World, Harvester> world_from_harvester(Nanoseconds time) const;
  Rigid<World, CameraCv> world_from_camera(Nanoseconds time) const;
  Rigid<PhantomFrame, CameraCv> phantom_from_camera(Nanoseconds time) const;
  /// The calibration board (BoardPattern); meaningless for other phantoms.
  Rigid<World, Board> world_from_board(Nanoseconds time) const;
  HarvesterTruth harvester(Nanoseconds time) const;

  /// True while the hand sweeps over the site; false while it approaches, withdraws or rests out of view.
  bool scanning(Nanoseconds time) const;

  const std::vector<MarkedSpot>& spots() const { return spots_; }

  /// Everything above for people and scripts: phantom, instrument, spots, poses at `poses_per_second` over
  /// `duration`. Times in it count from TwinOptions::start.
  std::string json(Nanoseconds duration, double poses_per_second) const;

  const Phantom& phantom() const { return *phantom_; }

 private:
  double seconds(Nanoseconds time) const;

  TwinOptions options_;
  std::shared_ptr<const Phantom> phantom_;
  std::shared_ptr<const Stage> stage_;
  std::shared_ptr<const HandMotion> hand_;
  std::vector<MarkedSpot> spots_;
};

}  // namespace linescope::twin
