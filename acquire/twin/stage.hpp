// Where things stand in the operating theatre: transmitter, object sensor, phantom.
#pragma once

#include <cstdint>

#include "acquire/twin/hand_options.hpp"
#include "acquire/twin/phantom.hpp"
#include "common/rigid_transform.hpp"

namespace linescope::twin {

/// The site lies some 350 mm from the transmitter, inside the tracker's best range (thesis 3.6: 225-640 mm),
/// and faces upwards; the LIBERTY's z points down.
class Stage {
 public:
  Stage(std::uint64_t seed, const HandOptions& options);

  /// Sensor 2 sits beside the site, turned: nobody mounts it square.
  Rigid<Object, PhantomFrame> object_from_phantom() const { return object_from_phantom_; }

  /// `seconds` since the beginning of the experiment.
  Rigid<World, Object> world_from_object(double seconds) const;

  /// The phantom before it moved: the frame in which the hand plans its way.
  Rigid<World, PhantomFrame> world_from_resting_phantom() const { return world_from_resting_phantom_; }

 private:
  Rigid<Object, PhantomFrame> object_from_phantom_;
  Rigid<World, PhantomFrame> world_from_resting_phantom_;
  double drift_mm_ = 0;
  double drift_rad_ = 0;
  Eigen::Vector3d drift_phase_;
};

}  // namespace linescope::twin
