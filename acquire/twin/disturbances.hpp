// What lies between surface and lens: glints that saturate the sensor, particles that float in the water.
#pragma once

#include <cstdint>

#include "acquire/twin/image_sensor.hpp"
#include "acquire/twin/optics_options.hpp"

namespace linescope::twin {

class Disturbances {
 public:
  Disturbances(std::uint64_t seed, const TroubleOptions& options) : seed_(seed), options_(options) {}

  /// Adds what is there at `seconds` since the beginning. Glints and particles live for about a second and
  /// drift. They are drawn only where the camera sees something.
  void add(LightImage& light, double seconds) const;

 private:
  void add_kind(LightImage& light, double seconds, double mean_number, std::uint64_t kind) const;

  std::uint64_t seed_;
  TroubleOptions options_;
};

}  // namespace linescope::twin
