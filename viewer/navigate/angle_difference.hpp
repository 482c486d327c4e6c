// The angle the surgeon acts on (thesis Eq 5.3), and its two signed parts on the operator's screen.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace linescope {

/// Eq 5.3: angle between surface normal and harvester axis, radians in [0, pi]. Any lengths but zero; exact
/// to the last digits also near 0 and pi, where the printed arccos loses half of them.
double angle_difference(const Eigen::Vector3d& normal, const Eigen::Vector3d& axis);

/// Signed tilts of the axis against the normal, radians in (-pi, pi]: positive when the handle leans to the
/// right (up) of the normal as the screen shows it. The two are angles in the planes (normal, right) and
/// (normal, up); for small tilts right^2 + up^2 = angle^2.
struct ScreenTilts {
  double right = 0;
  double up = 0;
};

/// `right` and `up` are the screen's axes in the same frame as the normal; each is made perpendicular to the
/// normal first. Nothing when one of them runs along the normal (within 0.5 degrees) or a vector has no
/// length: the screen cannot show it.
std::optional<ScreenTilts> screen_tilts(const Eigen::Vector3d& normal, const Eigen::Vector3d& axis,
                                        const Eigen::Vector3d& right, const Eigen::Vector3d& up);

/// How far the tip is from a surface that is locally a plane through `foot`, mm.
struct TipDistance {
  double distance = 0;  ///< perpendicular to the surface, positive outside
  double depth = 0;     ///< along the axis to the foot, positive before contact, negative inside
};
TipDistance tip_distance(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, const Eigen::Vector3d& foot,
                         const Eigen::Vector3d& normal);

}  // namespace linescope
