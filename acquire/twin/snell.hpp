// Refraction of a direction at a flat face (Snell's law in vector form).
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>

namespace linescope::twin {

/// `direction` and `normal` are unit vectors with direction . normal > 0 (the normal points to where the
/// light goes). The light comes from index `n_from` and enters `n_to`. Nothing at total reflection.
inline std::optional<Eigen::Vector3d> refracted(const Eigen::Vector3d& direction,
                                                const Eigen::Vector3d& normal, double n_from, double n_to) {
  const double ratio = n_from / n_to;
  const double cosine = direction.dot(normal);
  const double rest = 1 - ratio * ratio * (1 - cosine * cosine);
  if (rest < 0) return std::nullopt;
  return ratio * direction + (std::sqrt(rest) - ratio * cosine) * normal;
}

}  // namespace linescope::twin
