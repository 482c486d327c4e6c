// A measured point of the surface.
#pragma once

#include <Eigen/Core>

namespace linescope {

struct SurfacePoint {
  Eigen::Vector3f position;      ///< mm; world, unless the name of the container says otherwise
  float intensity = 0;           ///< peak of the laser line there, 0..255
  float standard_deviation = 0;  ///< of the position along the viewing direction, mm
};
static_assert(sizeof(SurfacePoint) == 20);

}  // namespace linescope
