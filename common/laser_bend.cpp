#include "common/laser_bend.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace linescope {
namespace {

/// Of a term times the plane's offset, which is a pure number: a strong prism has 0.3.
constexpr double kMostBend = 20;

}  // namespace

std::size_t LaserBend::terms() const {
  const auto used = [this](std::size_t first, std::size_t last) {
    return std::any_of(b.begin() + static_cast<std::ptrdiff_t>(first),
                       b.begin() + static_cast<std::ptrdiff_t>(last), [](double term) { return term != 0; });
  };
  if (used(kQuadratic, kCubic)) return kCubic;
  return used(0, kQuadratic) ? kQuadratic : 0;
}

LaserBend turned_over(const LaserBend& bend) {
  const auto& b = bend.b;
  return {{b[0], -b[1], b[2], b[3], -b[4], b[5], -b[6]}};
}

std::optional<double> depth_along(const LaserPlane& plane, const LaserBend& bend, double x, double y) {
  const double slope = plane.normal.x() * x + plane.normal.y() * y + plane.normal.z();
  const double inverse = slope / plane.offset + bend.at(x, y);
  // As for the plane: 1e-12 of the offset.
  if (!(inverse * std::abs(plane.offset) > 1e-12)) return std::nullopt;
  return 1 / inverse;
}

Result<void> validate(const LaserBend& bend, const LaserPlane& plane) {
  for (const double term : bend.b) {
    if (!std::isfinite(term)) return fail(ErrorCode::invalid, "laser_bend holds a number that is not finite");
    if (std::abs(term * plane.offset) > kMostBend) {
      return fail(
          ErrorCode::invalid,
          fmt::format("laser_bend holds {:g}, which bends the light right out of a plane {:g} mm from "
                      "the camera: its numbers must be in 1/mm; without laser_bend the surface is a "
                      "plane",
                      term, std::abs(plane.offset)));
    }
  }
  return {};
}

}  // namespace linescope
