// How the simulated LIBERTY errs.
#pragma once

#include <Eigen/Core>
#include <string_view>

#include "common/result.hpp"
#include "common/time.hpp"

namespace linescope::twin {

struct TrackerNoise {
  double rate_hz = 240.0;        ///< nominal
  double clock_drift_ppm = 0.0;  ///< real units: 239.9986 .. 240.0047 Hz, that is -6 .. +20 ppm
  double time_jitter_us = 0.0;  ///< by how much cycles arrive late at the host: half of a normal distribution
  Nanoseconds latency = 0;      ///< time stamp minus true instant, constant and unknown to the host
  double position_sigma_mm = 0.0;   ///< white, per axis
  double rotation_sigma_rad = 0.0;  ///< white, per axis
  double field_position_mm =
      0.0;  ///< RMS length of the field's distortion; depends on the place, the same at every time
  double field_rotation_rad = 0.0;   ///< RMS angle of the same
  double field_wavelength_mm = 250;  ///< smallest wavelength of the distortion
  double position_step_mm = 0.0;     ///< quantisation; LIBERTY: 0.0012 mm
  double rotation_step_rad = 0.0;    ///< quantisation of the Euler angles
  double dropouts_per_second = 0.0;  ///< per station, mean number
  double dropout_seconds = 0.15;     ///< mean length
  Eigen::Vector3d hemisphere{
      1, 0, 0};  ///< the half space in which the sensors are taken to be; (0,0,0) = always right
};

/// "ideal", "manufacturer" (0.76 mm and 0.15 degrees RMS static accuracy, resolution 0.0012 mm), "thesis"
/// (what the thesis itself cites of the LIBERTY, 0.25 mm and 0.1 degrees, as white noise, on top of
/// "manufacturer").
Result<TrackerNoise> tracker_noise_from_name(std::string_view name);

Result<void> validate(const TrackerNoise& options);

}  // namespace linescope::twin
