// The prism against the thesis's printed figures (3.5.1, Table 3.3) and against plain trigonometry.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "acquire/twin/prism.hpp"
#include "common/units.hpp"

namespace linescope::twin {
namespace {

using testing::HasSubstr;

constexpr double kHundredthDegree =
    0.006 * std::numbers::pi / 180;  // half a unit of the last printed digit, and a bit

double rad(double degrees) {
  return radians_from_degrees(degrees);
}

TEST(Prism, ApexAngleOfTable33NeedsWaterIndex133) {
  EXPECT_NEAR(*apex_for_deviation({1.0, 1.49, 1.33}, rad(14)), rad(58.20), kHundredthDegree);
  // Printed as 53.35, a hundredth more than the equation gives.
  EXPECT_NEAR(*apex_for_deviation({1.0, 1.53, 1.33}, rad(14)), rad(53.34), kHundredthDegree);
}

TEST(Prism, CriticalAngleOfTable33NeedsWaterIndex1333) {
  EXPECT_NEAR(*critical_angle({1.0, 1.49, 1.333}), rad(63.46), kHundredthDegree);
  EXPECT_NEAR(*critical_angle({1.0, 1.53, 1.333}), rad(60.60), kHundredthDegree);
  // With the index that the table's apex angles need, the critical angles are others than printed.
  EXPECT_NEAR(*critical_angle({1.0, 1.49, 1.33}), rad(63.20), kHundredthDegree);
  EXPECT_NEAR(*critical_angle({1.0, 1.53, 1.33}), rad(60.38), kHundredthDegree);
}

TEST(Prism, TheChosenApexOf54DegreesDeviatesByElevenToFourteenAndAHalf) {
  EXPECT_NEAR(prism_angles({1.0, 1.49, 1.33}, rad(54))->gamma, rad(11.0), rad(0.05));
  EXPECT_NEAR(prism_angles({1.0, 1.53, 1.33}, rad(54))->gamma, rad(14.5), rad(0.05));
}

TEST(Prism, AnglesFollowSnellAtBothFaces) {
  const PrismIndices n{1.0, 1.51, 1.34};
  const auto a = prism_angles(n, rad(40), rad(10));
  ASSERT_TRUE(a);
  EXPECT_NEAR(n.air * std::sin(rad(10)), n.prism * std::sin(a->theta0_prime), 1e-12);
  EXPECT_NEAR(n.prism * std::sin(a->theta1), n.medium * std::sin(a->theta1_prime), 1e-12);
  EXPECT_NEAR(a->theta1 + a->theta0_prime, rad(40), 1e-12);
  EXPECT_NEAR(a->gamma, rad(10) + a->theta1_prime - rad(40), 1e-12);
}

TEST(Prism, DesignedApexGivesTheDeviationBack) {
  for (const double degrees : {2.0, 8.0, 14.0, 20.0}) {
    const PrismIndices n{1.0, 1.5, 1.33};
    const auto apex = apex_for_deviation(n, rad(degrees));
    ASSERT_TRUE(apex) << apex.error().message;
    EXPECT_NEAR(prism_angles(n, *apex)->gamma, rad(degrees), 1e-9);
  }
}

TEST(Prism, TotalReflectionIsRefusedWithTheCriticalAngle) {
  // The prism of system II in air: nothing comes out.
  const auto in_air = prism_angles({1.0, 1.53, 1.0}, rad(54));
  ASSERT_FALSE(in_air);
  EXPECT_EQ(in_air.error().code, ErrorCode::invalid);
  EXPECT_THAT(in_air.error().message, HasSubstr("reflects totally"));
  EXPECT_THAT(in_air.error().message, HasSubstr("40.81"));  // asin(1/1.53)
}

TEST(Prism, ImpossibleDeviationNamesTheLargest) {
  const auto apex = apex_for_deviation({1.0, 1.49, 1.33}, rad(40));
  ASSERT_FALSE(apex);
  EXPECT_THAT(apex.error().message, HasSubstr("26.80"));  // 90 - 63.20
}

TEST(Prism, DenserMediumHasNoCriticalAngle) {
  const auto angle = critical_angle({1.0, 1.3, 1.33});
  ASSERT_FALSE(angle);
  EXPECT_EQ(angle.error().code, ErrorCode::unsupported);
}

TEST(Prism, ImpossibleIndexIsRefused) {
  EXPECT_FALSE(prism_angles({1.0, 0.5, 1.33}, 0.5));
  EXPECT_FALSE(critical_angle({1.0, std::nan(""), 1.33}));
}

}  // namespace
}  // namespace linescope::twin
