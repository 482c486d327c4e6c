// How endoscope and harvester are moved to calibrate them. Closed forms of time, seeded, random access; what
// the hand adds (tremor) is not in it.
#pragma once

#include <cstdint>
#include <vector>

#include "acquire/twin/instrument_options.hpp"
#include "acquire/twin/phantom.hpp"
#include "common/rigid_transform.hpp"

namespace linescope::twin {

/// Tip, axis and turn in the phantom's frame.
struct HarvesterHold {
  Eigen::Vector3d tip;
  Eigen::Vector3d axis;  ///< unit, from the tip to the handle
  double spin_rad = 0;   ///< turn about the axis
};

inline constexpr int kBoardViews = 40;           ///< of one round of views
inline constexpr double kViewHoldSeconds = 0.6;  ///< the endoscope stands at a view
inline constexpr double kViewMoveSeconds = 0.4;  ///< and goes on to the next
inline constexpr double kSpinSeconds = 8.0;      ///< to and fro

class CalibrationMotion {
 public:
  CalibrationMotion(std::uint64_t seed, const LensNumbers& lens, const BoardPattern& pattern);

  /// From view to view, each with the whole pattern in the picture: distances 10 to 20 mm, tilts to 35
  /// degrees to all sides, turned about the optical axis by up to 40 degrees, the pattern all over the
  /// picture.
  Rigid<PhantomFrame, CameraCv> views(double seconds) const;

  /// To and fro before the middle of the pattern without ever repeating itself: the motion from which the
  /// latency is found.
  Rigid<PhantomFrame, CameraCv> shake(double seconds) const;

  /// Tip in a divot beside the pattern, the tool swinging to all sides by up to 35 degrees.
  static HarvesterHold pivot(double seconds);

  /// Turned about its own axis in a bushing, by 150 degrees to both sides.
  static HarvesterHold spin(double seconds);

 private:
  std::vector<Rigid<PhantomFrame, CameraCv>> views_;
};

}  // namespace linescope::twin
