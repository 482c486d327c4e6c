// What light does between fibre, surface and 8-bit picture. Every effect has its own switch or strength; 0 or
// false is off.
#pragma once

#include <string_view>

#include "common/result.hpp"

namespace linescope::twin {

struct PrismOptions {
  bool refracted_sheet =
      false;               ///< true: the sheet is traced through the prism and comes out bent; false: a plane
  double air_index = 1.0;  ///< n_a
  double prism_index = 1.53;   ///< n_p
  double medium_index = 1.33;  ///< n_w; 1.0 in air
};

struct PortOptions {
  bool refraction = false;     ///< true: the camera sits in air behind a flat window
  double window_index = 1.52;  ///< glass
  double window_thickness_mm = 0.5;
  double pupil_distance_mm = 0.8;  ///< entrance pupil to the window's inner face
};

struct LineOptions {
  double brightness =
      190.0;  ///< grey levels at the reference distance, straight on, in the middle of the fan
  double reference_distance_mm = 15;  ///< from the fibre's virtual source
  double width_sigma_mm = 0.09;       ///< of the profile across the sheet, at focus
  double focus_distance_mm = 14.0;    ///< where the projector is sharp (thesis 4.4.1: best below 20 mm)
  double defocus_per_mm = 0.010;      ///< growth of sigma per mm off focus, added in squares
  double fan_half_angle_rad = 0.30;   ///< in the medium; the light falls to 1/e^2 there
  double speckle_contrast = 0.25;     ///< standard deviation over mean; 0 = none
  double speckle_size_px = 1.6;       ///< correlation length
  double sheet_reach_sigmas = 3.5;    ///< the profile is drawn that far
};

struct LightOptions {
  double led_brightness = 45.0;  ///< grey levels of a white surface straight ahead at the reference distance
  double reference_distance_mm = 15;
  double texture = 0.08;  ///< relative variation of the surface's colour
};

struct SensorOptions {
  double read_noise = 1.0;          ///< grey levels
  double electrons_per_level = 40;  ///< shot noise: variance = level / this; 0 = none
  double bloom = 0.15;  ///< share of what is above saturation that spills to each neighbour along the column
  bool chroma_subsampling = true;  ///< 4:2:2 as UVC cameras send
  int motion_samples = 3;          ///< instants per exposure; 1 = no motion blur
};

struct TroubleOptions {
  double missing = 0.0;           ///< share of the line that soft tissue hides, 0 .. 0.5
  double blood = 0.0;             ///< share of the surface that is dark red
  double glints = 0.0;            ///< specular spots per picture, mean number
  double inter_reflection = 0.0;  ///< brightness of the second line against the first
  double particles = 0.0;         ///< floating particles per picture, mean number
};

struct OpticsOptions {
  PrismOptions prism;
  PortOptions port;
  LineOptions line;
  LightOptions light;
  SensorOptions sensor;
  TroubleOptions trouble;
};

/// "ideal" (no noise, no light but the laser's, no distortion of anything by the sensor), "clean" (noise and
/// LED, but a flat sheet and no port: the calibration can be exact), "full" (clean, with prism and port
/// refraction), "trouble" (full, with everything that goes wrong in a knee).
Result<OpticsOptions> optics_from_name(std::string_view name);

Result<void> validate(const OpticsOptions& options);

}  // namespace linescope::twin
