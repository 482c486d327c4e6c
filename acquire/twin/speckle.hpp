// Laser speckle: the grain of coherent light on a rough surface. It boils from picture to picture while the
// hand moves.
#pragma once

#include <cmath>
#include <cstdint>

#include "acquire/twin/noise_texture.hpp"
#include "acquire/twin/optics_options.hpp"

namespace linescope::twin {

/// Factor on the laser's level at a pixel: mean 1, standard deviation `speckle_contrast`, never negative.
/// Log-normal, which is close to the gamma law of partly averaged speckle at contrasts up to 0.5.
double speckle_factor(const LineOptions& line, std::uint64_t seed, std::uint64_t picture, int u, int v);

}  // namespace linescope::twin
