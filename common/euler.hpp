// Azimuth, elevation, roll as the LIBERTY prints them and the thesis writes them (Eqs 4.5-4.8): R = Rz(psi)
// Ry(theta) Rx(phi).
#pragma once

#include <Eigen/Geometry>

namespace linescope {

/// Radians. Azimuth and roll in (-pi, pi], elevation in [-pi/2, pi/2] (thesis 3.6).
struct EulerAngles {
  double azimuth = 0;    ///< psi, about z
  double elevation = 0;  ///< theta, about y
  double roll = 0;       ///< phi, about x
};

/// Any angles are accepted; an elevation beyond 90 degrees gives the rotation it means, which reads back
/// folded.
Eigen::Quaterniond quaternion_from_euler(const EulerAngles& angles);

/// Angles in the ranges above. At elevation +-90 degrees azimuth and roll turn about the same axis (gimbal
/// lock): roll is reported 0 and azimuth carries the whole turn, so that the rotation itself survives the
/// round trip.
EulerAngles euler_from_quaternion(const Eigen::Quaterniond& rotation);

/// The same angle in (-pi, pi].
double wrapped(double radians);

}  // namespace linescope
