// The metal test: two sensors fixed to each other in a field whose error is known in closed form.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "tools/calibrate/check_step.hpp"
#include "tools/calibrate/pair_check.hpp"

namespace linescope::calibrate {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using testing::HasSubstr;

const Vector3d kLever(60, 0, 10);

/// What the field does to a place, mm.
using Field = std::function<Vector3d(const Vector3d&)>;

struct Pair {
  std::vector<PoseSample> first, second;

  void add(Nanoseconds time, const Vector3d& a, const Vector3d& b,
           const Quaterniond& turn = Quaterniond(1, 0, 0, 0)) {
    PoseSample sample;
    sample.time = time;
    sample.state = ToolState::ok;
    sample.world_from_sensor = {Quaterniond(1, 0, 0, 0), a};
    first.push_back(sample);
    sample.world_from_sensor = {turn, b};
    second.push_back(sample);
  }
};

/// Held for half a second at places along x, `apart` mm from each other, with a way of three samples between.
Pair carried(int places, double apart, const Field& field, double noise_mm = 0.02) {
  std::mt19937_64 engine(4);
  std::normal_distribution<double> normal(0, noise_mm);
  const auto noise = [&] { return Vector3d(normal(engine), normal(engine), normal(engine)); };
  Pair pair;
  Nanoseconds time = 0;
  for (int k = 0; k < places; ++k) {
    for (int i = 0; i < 123; ++i, time += kSecond / 240) {
      const double way = k + (i < 120 ? 0 : (i - 119) / 4.0);
      const Vector3d at(150 + way * apart, 40, -60);
      pair.add(time, at + field(at) + noise(), at + kLever + field(at + kLever) + noise());
    }
  }
  return pair;
}

Vector3d undisturbed(const Vector3d&) {
  return Vector3d::Zero();
}

/// a x^2 along x: the pair's distance then differs by 2 a x Lx from place to place.
Vector3d bent(const Vector3d& p) {
  return {2e-4 * p.x() * p.x(), 0, 0};
}

TEST(PairCheck, AnUndisturbedFieldShowsTheTrackersNoiseOnly) {
  const Pair pair = carried(6, 50, undisturbed);
  const auto check = check_pair(pair.first, pair.second);
  ASSERT_TRUE(check) << check.error().message;
  ASSERT_EQ(check->places.size(), 6u);
  EXPECT_NEAR(check->distance_mm, kLever.norm(), 0.01);
  EXPECT_LT(check->rms_mm, 0.02 * std::sqrt(6.0 / 120) * 1.5);
  EXPECT_NEAR(check->extent_mm, 250, 1);
  EXPECT_TRUE(above_limit(*check, {}));
}

TEST(PairCheck, ABentFieldIsMeasuredAndItsWorstPlaceNamed) {
  const Pair pair = carried(6, 50, bent);
  const auto check = check_pair(pair.first, pair.second);
  ASSERT_TRUE(check) << check.error().message;
  // 2 a Lx = 0.024 per mm; six places 50 mm apart have a standard deviation of 50 sqrt(35 / 12).
  EXPECT_NEAR(check->rms_mm, 0.024 * 50 * std::sqrt(35.0 / 12), 0.03);
  EXPECT_NEAR(check->worst_mm, 0.024 * 125, 0.05);
  const auto limit = above_limit(*check, {});
  ASSERT_FALSE(limit);
  EXPECT_EQ(limit.error().code, ErrorCode::above_limit);
  EXPECT_THAT(limit.error().message, HasSubstr("Move metal"));
}

TEST(PairCheck, ATurnThatDiffersFromPlaceToPlaceIsMeasured) {
  Pair pair;
  for (int k = 0; k < 5; ++k)
    for (int i = 0; i < 60; ++i) {
      const Vector3d at(100 + 60 * k, 0, 0);
      // 0, 1, 2, 3, 4 degrees: standard deviation sqrt(2) degrees.
      pair.add((k * 60 + i) * kSecond / 240, at, at + kLever,
               Quaterniond(Eigen::AngleAxisd(k * M_PI / 180, Vector3d::UnitZ())));
    }
  const auto check = check_pair(pair.first, pair.second);
  ASSERT_TRUE(check) << check.error().message;
  EXPECT_NEAR(check->rms_deg, std::sqrt(2.0), 0.001);
  EXPECT_NEAR(check->worst_deg, 2, 0.001);
  EXPECT_FALSE(above_limit(*check, {}));
}

TEST(PairCheck, OnePlaceAndAHiddenSensorAreRefused) {
  const Pair resting = carried(6, 1, undisturbed);
  const auto one = check_pair(resting.first, resting.second);
  ASSERT_FALSE(one);
  EXPECT_EQ(one.error().code, ErrorCode::too_little_variation);
  EXPECT_THAT(one.error().message, HasSubstr("at 1 places 40 mm apart, 5 are needed"));
  Pair hidden = carried(6, 50, undisturbed);
  for (PoseSample& sample : hidden.second) sample.state = ToolState::out_of_view;
  EXPECT_EQ(check_pair(hidden.first, hidden.second).error().code, ErrorCode::too_few);
}

TEST(PairCheck, LimitsThatCannotBeAreRefused) {
  EXPECT_TRUE(validate(PairOptions{}));
  EXPECT_FALSE(validate(PairOptions{.spacing_mm = 0}));
  EXPECT_FALSE(validate(PairOptions{.least_places = 1}));
}

TEST(CheckStep, TheMetalTestAloneNeedsNeitherPicturesNorABody) {
  CheckStep step;
  step.tests() = {.body = false, .still = false, .metal_pair = {1, 3}};
  ASSERT_TRUE(step.validate());
  EXPECT_TRUE(step.wants({}).poses_only);
  for (const auto& [field, good] : {std::pair{Field(undisturbed), true}, {Field(bent), false}}) {
    const Pair pair = carried(6, 50, field);
    Session session;
    session.poses[0] = pair.first, session.poses[2] = pair.second;
    const auto outcome = step.run(session, {}, {});
    ASSERT_TRUE(outcome) << outcome.error().message;
    EXPECT_EQ(!outcome->refused, good);
    ASSERT_EQ(outcome->plots.size(), 1u);
    EXPECT_EQ(outcome->plots[0].name, "check-metal");
  }
}

TEST(CheckStep, APairIsTwoDifferentSensorsAndSomethingIsTested) {
  CheckStep step;
  step.tests() = {.metal_pair = {2}};
  EXPECT_FALSE(step.validate());
  step.tests() = {.metal_pair = {2, 2}};
  EXPECT_FALSE(step.validate());
  step.tests() = {.body = false, .still = false, .metal_pair = {}};
  EXPECT_FALSE(step.validate());
}

}  // namespace
}  // namespace linescope::calibrate
