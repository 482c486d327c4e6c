// A camera behind a flat port seen as a pinhole with lens distortion: what calibrating it under water gives.
#pragma once

#include "acquire/twin/twin_options.hpp"

namespace linescope::twin {

/// Least squares over pixels and depths of the working range (8-22 mm) by Gauss and Newton, numerical
/// derivatives.
LensNumbers fitted_lens(const TwinOptions& options);

}  // namespace linescope::twin
