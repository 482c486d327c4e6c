// The simulated endoscope: what its camera, its laser and its mounting are in truth.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string_view>

#include "common/result.hpp"
#include "common/rigid_transform.hpp"
#include "common/time.hpp"

namespace linescope::twin {

/// Plain numbers of a lens: pixels, the centre of the first pixel is (0, 0); k1 k2 p1 p2 k3.
struct LensNumbers {
  int width = 360;
  int height = 240;
  double fx = 304.9807, fy = 304.98115;
  double cx = 179.5017, cy = 119.48865;
  std::array<double, 5> distortion{-0.3579, -0.2402, -0.0197, 0.0188, 0};
};

struct InstrumentOptions {
  LensNumbers lens;          ///< as seen in the medium it works in (thesis camera II: calibrated in water)
  double baseline_mm = 6.0;  ///< b of Eq 4.3
  double alpha_rad = 0.24434609527920614;  ///< deviation of the laser against the optical axis: 14 degrees
  double frame_rate_hz = 30.0;
  double exposure_ms = 8.0;
  Nanoseconds latency = 0;  ///< time stamp minus true middle of exposure
  Rigid<Endoscope, CameraCv> endoscope_from_camera =
      default_mounting();                             ///< sensor 1 on the handle, 150 mm behind the tip
  Eigen::Vector3d harvester_tip{-182.0, 6.5, -11.0};  ///< mm, in the frame of sensor 3
  Eigen::Vector3d harvester_axis =
      Eigen::Vector3d(0.995, -0.035, 0.06).normalized();  ///< from the tip to the handle

  static Rigid<Endoscope, CameraCv> default_mounting();
};

/// Thesis cameras: "camera-ii" at 360x240 (the default; the video of section 4.2.2), "camera-ii-320" at
/// 320x240 (the effective pixels of Table 3.1, the same view, so not square), "camera-i" at 640x480. "near":
/// camera II with a prism closer by (3.5 mm) that bends more (20 degrees), whose line stays in the picture at
/// gaps of 5 to 8 mm, where the thesis's geometry loses it.
Result<InstrumentOptions> instrument_from_name(std::string_view name);

Result<void> validate(const InstrumentOptions& options);

}  // namespace linescope::twin
