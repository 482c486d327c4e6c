// The daily check of an instrument whose laser is red and stands beside the camera: its line runs from top to
// bottom.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "acquire/laser/line_extractor.hpp"
#include "common/units.hpp"
#include "tests/unit/laser/line_scene.hpp"
#include "tools/calibrate/check_step.hpp"

namespace linescope::calibrate {
namespace {

constexpr double kBaseline = 6, kFocal = 300, kMiddle = 159.5, kLean = 0.1;
constexpr int kPictures = 48;
const double kSlope = std::tan(radians_from_degrees(14));

/// x + z tan(alpha) = b, as Eq 4.3 with x for y.
Calibration instrument() {
  Calibration c;
  c.camera = {320, 240, kFocal, kFocal, 0, kMiddle, 119.5, {}};
  const LaserPlane above = laser_plane_from_baseline(kBaseline, radians_from_degrees(14));
  c.laser = {{above.normal.y(), 0, above.normal.z()}, above.offset};
  return c;
}

/// To and fro twice over 24 mm.
double way_at(int picture) {
  const double part = std::fmod(4.0 * picture / kPictures, 2.0);
  return 24 * (part < 1 ? part : 2 - part) - 12;
}

/// A plane at 15 mm that falls off by a tenth along the way: z + kLean x = 15 in the room, so that the light
/// meets it at z (1 - kLean tan(alpha)) = 15 - kLean (way + b).
cv::Mat picture_of(double way) {
  const double z = (15 - kLean * (way + kBaseline)) / (1 - kLean * kSlope);
  const double u = kMiddle + kFocal * (kBaseline / z - kSlope);
  linescope::testing::LineScene scene;
  scene.width = 320;
  scene.height = 240;
  scene.colour = LaserColour::red;
  scene.axis = ProfileAxis::row;
  scene.noise = 1;
  scene.stripes = {{.centre = [u](double) { return u; }}};
  return scene.draw();
}

PoseSample pose_at(Nanoseconds time, double way) {
  PoseSample sample;
  sample.time = time;
  sample.state = ToolState::ok;
  sample.world_from_sensor = {Eigen::Quaterniond::Identity(), {way, 0, 0}};
  return sample;
}

/// As collect() gathers it: with what the step wants to be looked for.
Session scanned_for(const CheckStep& step) {
  Session session;
  session.width = 320;
  session.height = 240;
  LineExtractor extractor(*step.wants({}).line);
  for (int i = 0; i < kPictures; ++i) {
    const Nanoseconds time = (i + 1) * 33 * kMillisecond;
    Observation seen;
    seen.name = "picture " + std::to_string(i);
    seen.time = time;
    seen.line = extractor.extract(picture_of(way_at(i))).samples;
    if (!seen.line.empty()) session.observations.push_back(seen);
    for (const Nanoseconds beside : {-kMillisecond, kMillisecond})
      session.poses[0].push_back(pose_at(time + beside, way_at(i)));
    ++session.offered;
  }
  return session;
}

Result<Outcome> checked(const std::vector<std::string>& keys) {
  CheckStep step;
  ConfigSchema schema;
  step.declare(schema);
  for (const std::string& key : keys) EXPECT_TRUE(schema.set(key)) << key;
  return step.run(scanned_for(step), {}, instrument());
}

TEST(CheckLine, ARedLineFromTopToBottomIsFoundAndPlaced) {
  const auto outcome = checked({"check.still=false", "check.colour=red", "check.axis=row"});
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_FALSE(outcome->refused) << outcome->refused->message;
  EXPECT_EQ(outcome->quality.used, static_cast<std::size_t>(kPictures));
  EXPECT_LT(outcome->quality.residual, 0.05);
  const Figure& bias = outcome->quality.parameters.front();
  EXPECT_EQ(bias.name, "bias");
  EXPECT_LT(std::abs(bias.value), 0.05);
}

TEST(CheckLine, ByTheDefaultsItIsNoLine) {
  EXPECT_FALSE(checked({"check.still=false"}));
}

}  // namespace
}  // namespace linescope::calibrate
