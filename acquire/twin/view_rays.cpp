#include "acquire/twin/view_rays.hpp"

#include "acquire/twin/lens.hpp"
#include "acquire/twin/snell.hpp"

namespace linescope::twin {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Near the axis a flat port magnifies by the medium's index: a ray with slope s in the medium has slope n s
// in air. The lens behind the port is the one that makes the same picture of those slopes, so that both
// pictures agree in their middle.
LensNumbers behind_port(LensNumbers lens, double medium_index) {
  auto& [k1, k2, p1, p2, k3] = lens.distortion;
  const double n = medium_index, n2 = n * n;
  lens.fx /= n;
  lens.fy /= n;
  k1 /= n2;
  k2 /= n2 * n2;
  k3 /= n2 * n2 * n2;
  p1 /= n;
  p2 /= n;
  return lens;
}

}  // namespace

ViewRays::ViewRays(const LensNumbers& lens, const PortOptions& port, double medium_index)
    : lens_(port.refraction ? behind_port(lens, medium_index) : lens),
      port_(port),
      medium_index_(medium_index) {}

ViewRay ViewRays::at(double u, double v) const {
  const auto slope = Lens(lens_).slope(u, v);
  if (!slope) return {Vector3d::Zero(), Vector3d::Zero()};
  if (port_.refraction) return through_port(*slope);
  return {Vector3d::Zero(), Vector3d(slope->x(), slope->y(), 1).normalized()};
}

ViewRay ViewRays::through_port(const Vector2d& slope) const {
  const Vector3d in_air = Vector3d(slope.x(), slope.y(), 1).normalized();
  const auto in_glass = refracted(in_air, Vector3d::UnitZ(), 1.0, port_.window_index);
  const auto in_medium = refracted(*in_glass, Vector3d::UnitZ(), port_.window_index, medium_index_);
  const Vector3d sideways = in_air * (port_.pupil_distance_mm / in_air.z()) +
                            *in_glass * (port_.window_thickness_mm / in_glass->z());
  // Depth at which the pupil appears through window and medium, for rays near the axis.
  const double apparent =
      medium_index_ * (port_.pupil_distance_mm + port_.window_thickness_mm / port_.window_index);
  return {Vector3d(sideways.x(), sideways.y(), apparent), *in_medium};
}

RayTable::RayTable(const ViewRays& rays, int width, int height) : width_(width) {
  rays_.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) rays_.push_back(rays.at(u, v));
  }
}

}  // namespace linescope::twin
