// The surface that the laser's light forms in space, as the reconstruction needs it. Today it is a plane; a
// sheet bent by a lens or prism (quadric, table) becomes another class with the same two promises.
#pragma once

#include <concepts>

#include "common/laser_plane.hpp"

namespace linescope {

/// Where a ray (x, y, 1), OpenCV's camera frame, meets the surface.
struct SurfaceHit {
  float depth = 0;  ///< z in mm; not positive or not finite: the ray does not meet it in front of the camera
  float by_x = 0;   ///< change of the depth with x and y, mm: what noise in the picture does to the depth
  float by_y = 0;
};

template <class S>
concept LaserSurface = requires(const S& surface, float x, float y) {
  { surface.meet(x, y) }
  noexcept->std::same_as<SurfaceHit>;
};

class PlaneSurface {
 public:
  explicit PlaneSurface(const LaserPlane& plane) {
    const Eigen::Vector4f n = opencv_from_laser_plane(plane).cast<float>();  // n.p + d = 0
    nx_ = n(0), ny_ = n(1), nz_ = n(2), offset_ = -n(3);
  }

  SurfaceHit meet(float x, float y) const noexcept {
    const float inverse = 1 / (nx_ * x + ny_ * y + nz_);
    const float depth = offset_ * inverse;
    return {depth, -depth * nx_ * inverse, -depth * ny_ * inverse};
  }

 private:
  float nx_, ny_, nz_, offset_;
};
static_assert(LaserSurface<PlaneSurface>);

}  // namespace linescope
