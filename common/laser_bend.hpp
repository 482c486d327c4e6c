// What a prism bends the laser's light away from a plane by.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "common/laser_plane.hpp"
#include "common/result.hpp"

namespace linescope {

/// Added to the plane's inverse depth along the ray (x, y, 1), in the frame of LaserPlane (x right, y up, z
/// forward):
///
///   1/z = plane + b0 x^2 + b1 x y + b2 y^2 + b3 x^3 + b4 x^2 y + b5 x y^2 + b6 y^3      (1/mm)
///
/// The quadratic terms are a fan that is refracted more the further it runs off its middle; the cubic ones
/// account for its source not lying on the prism's last face (docs/calibrating.md). The plane is then the one
/// that touches the surface where the optical axis meets it. All zero: a plane.
struct LaserBend {
  static constexpr std::size_t kQuadratic = 3;  ///< terms of the quadratic form
  static constexpr std::size_t kCubic = 7;      ///< and with the cubic ones

  std::array<double, kCubic> b{};

  bool flat() const { return b == std::array<double, kCubic>{}; }
  /// How many of the terms are in use: 0, kQuadratic or kCubic.
  std::size_t terms() const;
  double at(double x, double y) const {
    return x * x * (b[0] + b[3] * x + b[4] * y) + y * (b[1] * x + b[2] * y) + y * y * (b[5] * x + b[6] * y);
  }
};

/// From OpenCV's frame (y down) to the thesis's and back: its own inverse.
LaserBend turned_over(const LaserBend& bend);

/// Depth z (mm) at which the ray through (x, y, 1) meets the bent surface; nothing when it runs along it or
/// meets it behind the camera.
std::optional<double> depth_along(const LaserPlane& plane, const LaserBend& bend, double x, double y);

/// Finite, and of the size that a bend in 1/mm can have beside this plane.
Result<void> validate(const LaserBend& bend, const LaserPlane& plane);

}  // namespace linescope
