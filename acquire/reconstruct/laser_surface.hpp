// The surface that the laser's light forms in space, as the reconstruction needs it: a plane, or the sheet
// that a prism bends. Each a class of its own, so that a plane costs what a plane costs.
#pragma once

#include <array>
#include <concepts>

#include "common/laser_bend.hpp"
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

/// Inverse depth is a polynomial of the ray, so that a ray meets the bent sheet in closed form too.
class BentSurface {
 public:
  BentSurface(const LaserPlane& plane, const LaserBend& bend) {
    const Eigen::Vector4d n = opencv_from_laser_plane(plane);
    const std::array<double, LaserBend::kCubic> b = turned_over(bend).b;
    for (int i = 0; i < 3; ++i) plane_[static_cast<std::size_t>(i)] = static_cast<float>(-n(i) / n(3));
    for (std::size_t i = 0; i < b.size(); ++i) bend_[i] = static_cast<float>(b[i]);
  }

  SurfaceHit meet(float x, float y) const noexcept {
    const auto& b = bend_;
    const float xx = x * x, xy = x * y, yy = y * y;
    const float inverse = plane_[0] * x + plane_[1] * y + plane_[2] + xx * (b[0] + b[3] * x + b[4] * y) +
                          b[1] * xy + yy * (b[2] + b[5] * x + b[6] * y);
    const float by_x = plane_[0] + 2 * b[0] * x + b[1] * y + 3 * b[3] * xx + 2 * b[4] * xy + b[5] * yy;
    const float by_y = plane_[1] + b[1] * x + 2 * b[2] * y + b[4] * xx + 2 * b[5] * xy + 3 * b[6] * yy;
    const float depth = 1 / inverse;
    return {depth, -depth * depth * by_x, -depth * depth * by_y};
  }

 private:
  std::array<float, 3> plane_;
  std::array<float, LaserBend::kCubic> bend_;
};
static_assert(LaserSurface<BentSurface>);

}  // namespace linescope
