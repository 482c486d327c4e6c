#include "acquire/twin/instrument_options.hpp"

#include <fmt/format.h>

#include <cmath>

#include "common/units.hpp"

namespace linescope::twin {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

// Table 3.1 and the results of 3.2.2; the numbers belong to a 720x480 picture.
LensNumbers camera_ii(int width, int height) {
  const double x = width / 720.0, y = height / 480.0;
  // Pixel centres are at whole numbers: the picture's edge lies half a pixel before the first.
  return {width,
          height,
          609.9614 * x,
          609.9623 * y,
          (359.5034 + 0.5) * x - 0.5,
          (239.4773 + 0.5) * y - 0.5,
          {-0.3579, -0.2402, -0.0197, 0.0188, 0}};
}

LensNumbers camera_i() {
  return {640, 480, 771.3048, 711.3048, 319.5, 239.5, {0.1852, -0.8874, 0.0043, -0.0069, 0}};
}

}  // namespace

Rigid<Endoscope, CameraCv> InstrumentOptions::default_mounting() {
  const Quaterniond turn = AngleAxisd(1.4, Vector3d::UnitY()) * AngleAxisd(0.3, Vector3d::UnitX()) *
                           AngleAxisd(-0.5, Vector3d::UnitZ());
  // The sensor sits 150 mm behind the tip and 25 mm beside the tube.
  return {turn, turn * Vector3d(12, -22, 150)};
}

Result<InstrumentOptions> instrument_from_name(std::string_view name) {
  InstrumentOptions options;
  if (name == "camera-ii") {
    options.lens = camera_ii(360, 240);
  } else if (name == "camera-ii-320") {
    options.lens = camera_ii(320, 240);
  } else if (name == "camera-i") {
    options.lens = camera_i();
  } else if (name == "near") {
    options.lens = camera_ii(360, 240);
    options.baseline_mm = 3.5;
    options.alpha_rad = radians_from_degrees(20);
  } else {
    return fail(
        ErrorCode::usage,
        fmt::format("no instrument is called '{}': use camera-i, camera-ii, camera-ii-320 or near", name));
  }
  return options;
}

Result<void> validate(const InstrumentOptions& options) {
  const LensNumbers& lens = options.lens;
  if (!(lens.width >= 16 && lens.width <= 8192 && lens.height >= 16 && lens.height <= 8192)) {
    return fail(ErrorCode::invalid, fmt::format("a picture of {} x {} pixels is not possible: use 16 to 8192",
                                                lens.width, lens.height));
  }
  if (!(lens.fx > 1 && lens.fy > 1 && std::isfinite(lens.cx + lens.cy))) {
    return fail(ErrorCode::invalid,
                "the lens's focal lengths must be above 1 pixel and its principal point a number");
  }
  if (!(options.baseline_mm > 0 && options.baseline_mm <= 200)) {
    return fail(ErrorCode::invalid,
                fmt::format("a baseline of {:g} mm is not possible: use more than 0, at most 200 mm",
                            options.baseline_mm));
  }
  if (!(std::abs(options.alpha_rad) < 1.2)) {
    return fail(ErrorCode::invalid, "the laser's deviation must be below 69 degrees (1.2 rad)");
  }
  if (!(options.frame_rate_hz >= 1 && options.frame_rate_hz <= 1000)) {
    return fail(ErrorCode::invalid, fmt::format("{:g} pictures per second are not possible: use 1 to 1000",
                                                options.frame_rate_hz));
  }
  if (!(options.exposure_ms >= 0 && options.exposure_ms <= 1000 / options.frame_rate_hz)) {
    return fail(ErrorCode::invalid,
                fmt::format("an exposure of {:g} ms does not fit between two pictures: use 0 to {:g} ms",
                            options.exposure_ms, 1000 / options.frame_rate_hz));
  }
  return {};
}

}  // namespace linescope::twin
