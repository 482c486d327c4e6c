#include <gtest/gtest.h>

#include "common/units.hpp"
#include "viewer/navigate/guidance.hpp"
#include "viewer/navigate/normal_estimate.hpp"

namespace linescope {
namespace {

NormalEstimate good(double degrees, double distance) {
  NormalEstimate e;
  e.reason = NormalReason::none;
  e.angle = radians_from_degrees(degrees);
  e.distance = e.depth = distance;
  return e;
}

TEST(Guidance, HoldsAfterHalfASecondWithinBothTolerances) {
  Guidance guidance;
  EXPECT_FALSE(guidance.update(good(2.9, 0.9), 0).held);
  for (int ms = 50; ms < 500; ms += 50)
    EXPECT_FALSE(guidance.update(good(2.9, 0.9), ms * kMillisecond).held) << ms;
  EXPECT_NEAR(guidance.state().held_share, 0.9, 1e-9);
  EXPECT_TRUE(guidance.update(good(2.9, 0.9), 500 * kMillisecond).held);
}

TEST(Guidance, EitherToleranceEndsTheHold) {
  for (const auto& bad : {good(3.4, 0.5), good(1, 1.3), good(1, -1.3)}) {
    Guidance guidance;
    guidance.update(good(1, 0.5), 0);
    guidance.update(bad, 90 * kMillisecond);
    EXPECT_FALSE(guidance.state().within);
    guidance.update(good(1, 0.5), 180 * kMillisecond);
    for (int ms = 270; ms < 680; ms += 80)
      EXPECT_FALSE(guidance.update(good(1, 0.5), ms * kMillisecond).held) << ms;
    EXPECT_TRUE(guidance.update(good(1, 0.5), 690 * kMillisecond).held);
  }
}

TEST(Guidance, SlackKeepsWithinFromFlickering) {
  Guidance guidance;
  EXPECT_FALSE(guidance.update(good(3.1, 0), 0).within);
  EXPECT_TRUE(guidance.update(good(2.9, 0), kMillisecond).within);
  EXPECT_TRUE(guidance.update(good(3.1, 0), 2 * kMillisecond).within);
  EXPECT_FALSE(guidance.update(good(3.4, 0), 3 * kMillisecond).within);
}

TEST(Guidance, DeadBandHoldsTheShownNumber) {
  Guidance guidance;
  guidance.update(good(5.0, 2.0), 0);
  const double shown = *guidance.state().angle;
  for (const double wobble : {5.1, 4.9, 5.15})
    EXPECT_EQ(*guidance.update(good(wobble, 2.05), 1).angle, shown);
  EXPECT_EQ(*guidance.state().distance, 2.0);
  EXPECT_NEAR(degrees_from_radians(*guidance.update(good(5.3, 2.2), 2).angle), 5.3, 1e-9);
  EXPECT_EQ(*guidance.state().distance, 2.2);
}

TEST(Guidance, BlanksAtOnceAndNeverShowsAnOldNumberAfterwards) {
  Guidance guidance;
  guidance.update(good(5.0, 2.0), 0);
  NormalEstimate refused;
  refused.reason = NormalReason::gap;
  EXPECT_FALSE(guidance.update(refused, kMillisecond).angle);
  EXPECT_FALSE(guidance.state().distance || guidance.state().depth);
  EXPECT_NEAR(degrees_from_radians(*guidance.update(good(5.1, 2), 2).angle), 5.1,
              1e-9);  // not the 5.0 within the band
}

TEST(Guidance, AShortPauseKeepsTheHoldALongOneDoesNot) {
  for (const auto& [pause, kept] : {std::pair{80, true}, {150, false}}) {
    Guidance guidance;
    for (int ms = 0; ms <= 400; ms += 20) guidance.update(good(1, 0), ms * kMillisecond);
    EXPECT_FALSE(guidance.blank((400 + pause / 2) * kMillisecond).within);
    guidance.update(good(1, 0), (400 + pause) * kMillisecond);
    for (int ms = 420 + pause; ms <= 560; ms += 20) guidance.update(good(1, 0), ms * kMillisecond);
    EXPECT_EQ(guidance.state().held, kept);
  }
}

TEST(Guidance, RefusesImpossibleOptions) {
  EXPECT_TRUE(validate(GuidanceOptions{}).has_value());
  EXPECT_FALSE(validate(GuidanceOptions{.angle_tolerance = 0}).has_value());
  EXPECT_FALSE(validate(GuidanceOptions{.distance_tolerance = -1}).has_value());
  EXPECT_FALSE(validate(GuidanceOptions{.hold = -1}).has_value());
  EXPECT_FALSE(validate(GuidanceOptions{.angle_dead_band = NAN}).has_value());
}

}  // namespace
}  // namespace linescope
