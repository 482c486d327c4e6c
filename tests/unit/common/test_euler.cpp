#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "common/euler.hpp"
#include "common/units.hpp"

namespace linescope {
namespace {

Eigen::Matrix3d printed(double psi, double theta, double phi) {
  // Eqs 4.6-4.8 typed from the thesis, entry by entry.
  Eigen::Matrix3d z, y, x;
  z << std::cos(psi), -std::sin(psi), 0, std::sin(psi), std::cos(psi), 0, 0, 0, 1;
  y << std::cos(theta), 0, std::sin(theta), 0, 1, 0, -std::sin(theta), 0, std::cos(theta);
  x << 1, 0, 0, 0, std::cos(phi), -std::sin(phi), 0, std::sin(phi), std::cos(phi);
  return z * y * x;
}

TEST(Euler, QuaternionIsTheProductOfThePrintedMatrices) {
  for (double psi : {-170.0, -40.0, 0.0, 75.0, 180.0})
    for (double theta : {-90.0, -30.0, 0.0, 60.0, 90.0})
      for (double phi : {-179.0, 0.0, 20.0, 140.0}) {
        const double a = radians_from_degrees(psi), e = radians_from_degrees(theta),
                     r = radians_from_degrees(phi);
        EXPECT_TRUE(quaternion_from_euler({a, e, r}).toRotationMatrix().isApprox(printed(a, e, r), 1e-12));
      }
}

TEST(Euler, AnglesComeBackWithinTheirRanges) {
  for (double psi : {-179.9, -90.0, 0.0, 33.0, 180.0})
    for (double theta : {-89.9, -12.0, 0.0, 45.0, 89.9})
      for (double phi : {-150.0, 0.0, 90.0, 180.0}) {
        const EulerAngles out = euler_from_quaternion(quaternion_from_euler(
            {radians_from_degrees(psi), radians_from_degrees(theta), radians_from_degrees(phi)}));
        EXPECT_NEAR(std::remainder(degrees_from_radians(out.azimuth) - psi, 360.0), 0, 1e-6);
        EXPECT_NEAR(degrees_from_radians(out.elevation), theta, 1e-6);
        EXPECT_NEAR(std::remainder(degrees_from_radians(out.roll) - phi, 360.0), 0, 1e-6);
        EXPECT_GT(out.azimuth, -std::numbers::pi - 1e-12);
        EXPECT_LE(out.azimuth, std::numbers::pi);
      }
}

TEST(Euler, ElevationBeyondNinetyDegreesFoldsBack) {
  // Turning on past the pole: the elevation comes down again while azimuth and roll jump by 180 degrees
  // (thesis Fig 3.9b).
  const EulerAngles out = euler_from_quaternion(quaternion_from_euler({0, radians_from_degrees(100), 0}));
  EXPECT_NEAR(degrees_from_radians(out.elevation), 80, 1e-9);
  EXPECT_NEAR(std::abs(degrees_from_radians(out.azimuth)), 180, 1e-9);
  EXPECT_NEAR(std::abs(degrees_from_radians(out.roll)), 180, 1e-9);
}

TEST(Euler, AzimuthAndRollWrapAtPlusMinus180) {
  const auto near_seam = [](double degrees) {
    return degrees_from_radians(
        euler_from_quaternion(quaternion_from_euler({radians_from_degrees(degrees), 0.1, 0})).azimuth);
  };
  EXPECT_NEAR(near_seam(179.5), 179.5, 1e-9);
  EXPECT_NEAR(near_seam(180.5), -179.5, 1e-9);
  EXPECT_DOUBLE_EQ(wrapped(-std::numbers::pi), std::numbers::pi);
  EXPECT_NEAR(wrapped(5 * std::numbers::pi / 2), std::numbers::pi / 2, 1e-12);
}

TEST(Euler, GimbalLockKeepsTheRotation) {
  for (double sign : {-1.0, 1.0}) {
    const Eigen::Quaterniond q = quaternion_from_euler({0.4, sign * std::numbers::pi / 2, -1.1});
    const EulerAngles out = euler_from_quaternion(q);
    EXPECT_DOUBLE_EQ(out.roll, 0);
    EXPECT_LT(quaternion_from_euler(out).angularDistance(q), 1e-6);
  }
}

}  // namespace
}  // namespace linescope
