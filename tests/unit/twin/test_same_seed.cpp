// Same options, same bytes: the promise that makes every figure of the evaluation repeatable.
#include <gtest/gtest.h>

#include <cstring>

#include "picture_line.hpp"
#include "twin_fixture.hpp"

namespace linescope::twin {
namespace {

TwinOptions everything_on(std::uint64_t seed) {
  TwinOptions options = demo_twin();
  EXPECT_TRUE(apply_noise_preset(options, "thesis"));
  options.optics = *optics_from_name("trouble");
  options.hand.scenario = Scenario::sweeps;
  options.tracker.dropouts_per_second = 0.5;
  options.seed = seed;
  return options;
}

bool same_sample(const PoseSample& a, const PoseSample& b) {
  return a.time == b.time && a.frame_count == b.frame_count && a.station == b.station && a.state == b.state &&
         a.world_from_sensor.translation() == b.world_from_sensor.translation() &&
         a.world_from_sensor.rotation().coeffs() == b.world_from_sensor.rotation().coeffs();
}

TEST(SameSeed, GivesTheSamePictures) {
  const auto first = pictures(everything_on(7), 8), second = pictures(everything_on(7), 8);
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_TRUE(same_pixels(first[i].bgr, second[i].bgr)) << "picture " << i;
    EXPECT_EQ(first[i].time, second[i].time);
  }
}

TEST(SameSeed, GivesTheSameSamples) {
  const auto first = samples(everything_on(7), 3000), second = samples(everything_on(7), 3000);
  for (std::size_t i = 0; i < first.size(); ++i)
    ASSERT_TRUE(same_sample(first[i], second[i])) << "sample " << i;
}

TEST(SameSeed, StartAgainBeginsAgain) {
  TwinCamera camera(experiment(everything_on(7)));
  Frame first, again;
  ASSERT_TRUE(camera.start());
  ASSERT_EQ(camera.next(first), Pull::item);
  ASSERT_TRUE(camera.start());
  ASSERT_EQ(camera.next(again), Pull::item);
  EXPECT_EQ(again.index, 0u);
  EXPECT_TRUE(same_pixels(first.bgr, again.bgr));
}

TEST(OtherSeed, GivesOtherPicturesAndSamples) {
  EXPECT_FALSE(
      same_pixels(pictures(everything_on(7), 3).back().bgr, pictures(everything_on(8), 3).back().bgr));
  EXPECT_FALSE(same_sample(samples(everything_on(7), 4).back(), samples(everything_on(8), 4).back()));
}

TEST(StartTime, ShiftsTheStampsAndNothingElse) {
  TwinOptions late = everything_on(7);
  late.start = 123'456'789'012;
  const auto now = pictures(everything_on(7), 3), then = pictures(late, 3);
  EXPECT_EQ(then[2].time - now[2].time, late.start);
  EXPECT_TRUE(same_pixels(now[2].bgr, then[2].bgr));
  const auto early_samples = samples(everything_on(7), 100), late_samples = samples(late, 100);
  EXPECT_EQ(late_samples[99].time - early_samples[99].time, late.start);
  EXPECT_EQ(late_samples[99].world_from_sensor.translation(),
            early_samples[99].world_from_sensor.translation());
}

}  // namespace
}  // namespace linescope::twin
