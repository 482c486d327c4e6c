#include "acquire/twin/optics_options.hpp"

#include <fmt/format.h>

#include <cmath>

namespace linescope::twin {
namespace {

OpticsOptions ideal() {
  OpticsOptions o;
  o.line.speckle_contrast = 0;
  o.line.sheet_reach_sigmas = 6;
  o.light.led_brightness = 0;
  o.light.texture = 0;
  o.sensor.read_noise = 0;
  o.sensor.electrons_per_level = 0;
  o.sensor.bloom = 0;
  o.sensor.chroma_subsampling = false;
  o.sensor.motion_samples = 1;
  return o;
}

OpticsOptions full() {
  OpticsOptions o;
  o.prism.refracted_sheet = true;
  o.port.refraction = true;
  return o;
}

OpticsOptions trouble() {
  OpticsOptions o = full();
  o.trouble = {0.35, 0.12, 2.5, 0.25, 6};
  return o;
}

struct Range {
  const char* what;
  double value, low, high;
};

Result<void> in_range(const Range& r) {
  if (r.value >= r.low && r.value <= r.high) return {};
  return fail(ErrorCode::invalid,
              fmt::format("{} of {:g} is not possible: use {:g} to {:g}", r.what, r.value, r.low, r.high));
}

}  // namespace

Result<OpticsOptions> optics_from_name(std::string_view name) {
  if (name == "ideal") return ideal();
  if (name == "clean") return OpticsOptions{};
  if (name == "full") return full();
  if (name == "trouble") return trouble();
  return fail(ErrorCode::usage,
              fmt::format("no optics are called '{}': use ideal, clean, full or trouble", name));
}

Result<void> validate(const OpticsOptions& o) {
  for (const Range& range :
       {Range{"a refractive index of air", o.prism.air_index, 1, 4},
        {"a refractive index of the prism", o.prism.prism_index, 1, 4},
        {"a refractive index of the medium", o.prism.medium_index, 1, 4},
        {"a refractive index of the window", o.port.window_index, 1, 4},
        {"a window thickness (mm)", o.port.window_thickness_mm, 0, 20},
        {"a pupil distance (mm)", o.port.pupil_distance_mm, 0, 20},
        {"a laser brightness (grey levels)", o.line.brightness, 0, 1e5},
        {"a reference distance of the laser (mm)", o.line.reference_distance_mm, 0.1, 1e4},
        {"a line width sigma (mm)", o.line.width_sigma_mm, 1e-3, 10},
        {"a defocus per mm", o.line.defocus_per_mm, 0, 1},
        {"a half angle of the fan (rad)", o.line.fan_half_angle_rad, 0.01, 1.2},
        {"a speckle contrast", o.line.speckle_contrast, 0, 1},
        {"a speckle size (px)", o.line.speckle_size_px, 0.5, 50},
        {"a reach of the sheet (sigmas)", o.line.sheet_reach_sigmas, 1, 10},
        {"an LED brightness (grey levels)", o.light.led_brightness, 0, 1e5},
        {"a reference distance of the LED (mm)", o.light.reference_distance_mm, 0.1, 1e4},
        {"a texture", o.light.texture, 0, 0.5},
        {"a read noise (grey levels)", o.sensor.read_noise, 0, 100},
        {"a number of electrons per level", o.sensor.electrons_per_level, 0, 1e6},
        {"a bloom", o.sensor.bloom, 0, 0.5},
        {"a number of instants per exposure", static_cast<double>(o.sensor.motion_samples), 1, 100},
        {"a missing share of the line", o.trouble.missing, 0, 0.9},
        {"a share of blood", o.trouble.blood, 0, 0.9},
        {"a number of glints", o.trouble.glints, 0, 100},
        {"a brightness of the second line", o.trouble.inter_reflection, 0, 1},
        {"a number of particles", o.trouble.particles, 0, 100}}) {
    if (auto valid = in_range(range); !valid) return valid;
  }
  return {};
}

}  // namespace linescope::twin
