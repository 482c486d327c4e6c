// What is printed on a surface: a reflectance that changes within less than a pixel.
#pragma once

#include <Eigen/Core>

namespace linescope::twin {

class Paint {
 public:
  virtual ~Paint() = default;

  /// Share of light that comes back from what one pixel sees (0..1, grey), the lens's blur included. `place`:
  /// where the pixel's ray meets the surface; `right`, `down`: how far that place moves to the next pixel;
  /// all in the phantom's frame, mm.
  virtual double reflectance(const Eigen::Vector3d& place, const Eigen::Vector3d& right,
                             const Eigen::Vector3d& down) const = 0;
};

}  // namespace linescope::twin
