#include "common/calibration.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "common/units.hpp"

namespace linescope {

Result<void> validate(const Calibration& c) {
  if (auto camera = validate(c.camera); !camera) return camera;
  const auto axis_depth = c.laser.depth_along(0, 0);
  // A laser sheet parallel to the optical axis never crosses it, which is a legal instrument; its baseline
  // still tells the unit.
  const double scale = axis_depth ? *axis_depth : std::abs(c.laser.offset);
  if (std::abs(c.laser.offset) > 1000 || scale > 10000) {
    return fail(ErrorCode::invalid,
                fmt::format("laser_plane lies {:g} mm from the camera: lengths must be in millimetres",
                            c.laser.offset));
  }
  if (std::abs(c.laser.offset) < 0.05) {
    return fail(
        ErrorCode::invalid,
        fmt::format("laser_plane lies {:g} mm from the camera, which leaves no baseline: lengths must be in "
                    "millimetres, not metres",
                    c.laser.offset));
  }
  if (auto bend = validate(c.laser_bend, c.laser); !bend) return bend;
  if (!c.endoscope_from_camera.finite() || c.endoscope_from_camera.translation().norm() > 5000) {
    return fail(ErrorCode::invalid,
                "endoscope_from_camera is not finite or longer than 5 m: it must be in millimetres");
  }
  if (!c.harvester.tip.allFinite() || std::abs(c.harvester.axis.norm() - 1) > 1e-6) {
    return fail(ErrorCode::invalid, "harvester_tip must be finite and harvester_axis a unit vector");
  }
  return {};
}

namespace {

Calibration thesis_instrument() {
  Calibration c;
  c.laser = laser_plane_from_baseline(6.0, radians_from_degrees(14.0));
  c.notes = {
      "endoscope_from_camera, harvester tip and axis are not printed in the thesis and are identity here"};
  return c;
}

}  // namespace

Calibration thesis_camera_i() {
  Calibration c = thesis_instrument();
  c.name = "thesis camera I";
  // fx and fy are printed 60 px apart for square pixels; kept as printed, one of them is probably a typing
  // slip.
  c.camera = {640, 480, 771.3048, 711.3048, 0, 319.5, 239.5, {0.1852, -0.8874, 0.0043, -0.0069, 0}};
  return c;
}

Calibration thesis_camera_ii() {
  Calibration c = thesis_instrument();
  c.name = "thesis camera II";
  // Calibrated at 720x480, whatever Table 3.1 says of the sensor: the principal point shows it.
  c.camera = {720, 480, 609.9614, 609.9623, 0, 359.5034, 239.4773, {-0.3579, -0.2402, -0.0197, 0.0188, 0}};
  return c;
}

}  // namespace linescope
