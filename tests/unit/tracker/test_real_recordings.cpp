#include <gtest/gtest.h>

#include <cstdio>

#include "acquire/tracker/frame_clock.hpp"
#include "acquire/tracker/picture_pose_source.hpp"
#include "acquire/tracker/pose_history.hpp"
#include "acquire/tracker/timed_pose_source.hpp"
#include "common/units.hpp"
#include "samples.hpp"
#include "tests/support/shared_data.hpp"

namespace linescope {
namespace {

using testing::read_all;
using testing::Told;

TEST(RealRecordings, TheMiniatureScannersFile) {
  LINESCOPE_NEEDS_SHARED_DATA();
  std::vector<PictureInstant> pictures;
  for (const int i : {0, 7, 24, 99}) pictures.push_back({"im" + std::to_string(i) + ".png", 1000 * i + 1});
  PicturePoseSource source(testing::shared_data("miniature-scanner/poses.csv"), pictures, {});
  ASSERT_TRUE(source.start());
  const Told told = read_all(source);
  ASSERT_EQ(told.samples.size(), 4u);
  EXPECT_TRUE(told.errors.empty());
  EXPECT_DOUBLE_EQ(told.samples[2].world_from_sensor.translation().z(), 297.688853457);
  EXPECT_NEAR(told.samples[1].world_from_sensor.rotation().w(), 0.80391577035795647, 1e-12);
  EXPECT_EQ(told.samples[3].state, ToolState::missing);
}

TEST(RealRecordings, ARealTwoSensorRecordingGivesOneSamplePerChange) {
  LINESCOPE_NEEDS_SHARED_DATA();
  TimedPoseSource source(testing::shared_data("tracker/liberty-two-sensors-a.csv"), {});
  ASSERT_TRUE(source.start());
  const Told told = read_all(source);
  EXPECT_TRUE(told.errors.empty()) << told.errors.front().message;
  const auto first = source.station(0);
  const auto second = source.station(1);
  const double seconds = seconds_from(told.samples.back().time - told.samples.front().time);
  // 120.0 to 120.3 new samples per second and sensor is what is known of these recordings.
  EXPECT_NEAR(static_cast<double>(first.samples) / seconds, 120.15, 0.4);
  EXPECT_NEAR(static_cast<double>(second.samples) / seconds, 120.15, 0.4);
  EXPECT_NEAR(told.samples.front().world_from_sensor.translation().x(), 7.287830710411072, 1e-12);
}

/// One station of a real recording, with its arrival times mapped by the running fit.
struct Mapped {
  std::vector<PoseSample> samples;  ///< time: mapped; arrival: as recorded
  FrameClockFigures clock;
};

Mapped map_recording(const char* file, int station) {
  TimedPoseSource source(testing::shared_data(file), {});
  Mapped mapped;
  if (!source.start()) return mapped;
  FrameClock clock({.nominal_hz = 120, .latency = 0});
  Nanoseconds last = 0;
  for (PoseSample& sample : read_all(source).samples) {
    if (sample.station != station) continue;
    clock.observe(sample.frame_count, sample.arrival);
    sample.time = last = std::max(last + 1, clock.time_of(sample.frame_count));
    mapped.samples.push_back(sample);
  }
  mapped.clock = clock.figures();
  return mapped;
}

struct Error95 {
  double rms_mm = 0, p95_mm = 0, rms_deg = 0, p95_deg = 0;
  int count = 0;
};

/// Every sample but those of the first two seconds is left out in turn and interpolated from its neighbours,
/// at the time `time_of` gives it.
template <class TimeOf>
Error95 leave_one_out(const std::vector<PoseSample>& samples, TimeOf time_of) {
  std::vector<double> mm, deg;
  double sum_mm = 0, sum_deg = 0;
  for (std::size_t k = 240; k + 1 < samples.size(); ++k) {
    PoseHistory history({.capacity = 2, .longest_gap = kSecond});
    for (const std::size_t i : {k - 1, k + 1}) {
      PoseSample neighbour = samples[i];
      neighbour.time = time_of(neighbour);
      history.add(neighbour);
    }
    const PoseAnswer answer = history.pose_at(samples[k].station, time_of(samples[k]));
    if (!answer.ok()) continue;
    const auto& truth = samples[k].world_from_sensor;
    mm.push_back((answer.world_from_sensor.translation() - truth.translation()).norm());
    deg.push_back(
        degrees_from_radians(answer.world_from_sensor.rotation().angularDistance(truth.rotation())));
    sum_mm += mm.back() * mm.back();
    sum_deg += deg.back() * deg.back();
  }
  std::sort(mm.begin(), mm.end());
  std::sort(deg.begin(), deg.end());
  const auto n = static_cast<double>(mm.size());
  const std::size_t p95 = mm.size() * 95 / 100;
  return {std::sqrt(sum_mm / n), mm[p95], std::sqrt(sum_deg / n), deg[p95], static_cast<int>(mm.size())};
}

class RealLiberty : public ::testing::TestWithParam<std::tuple<const char*, int>> {};

TEST_P(RealLiberty, TheClockFitSurvivesStallsAndInterpolationIsBetterForIt) {
  LINESCOPE_NEEDS_SHARED_DATA();
  const auto [file, station] = GetParam();
  const Mapped mapped = map_recording(file, station);
  ASSERT_GT(mapped.samples.size(), 800u);
  const Error95 fitted = leave_one_out(mapped.samples, [](const PoseSample& s) { return s.time; });
  const Error95 raw = leave_one_out(mapped.samples, [](const PoseSample& s) { return s.arrival; });
  std::printf("%s sensor %d: %.3f Hz, fit residual %.3f ms, typical lateness %.1f ms, worst %.1f ms\n", file,
              station + 1, mapped.clock.rate_hz, milliseconds_from(mapped.clock.fit_residual),
              milliseconds_from(mapped.clock.typical_lateness),
              milliseconds_from(mapped.clock.worst_lateness));
  std::printf(
      "  leave-one-out (%d): fitted times rms %.4f mm %.5f deg, p95 %.4f mm %.5f deg; arrival times rms %.4f "
      "mm "
      "%.5f deg (%d)\n",
      fitted.count, fitted.rms_mm, fitted.rms_deg, fitted.p95_mm, fitted.p95_deg, raw.rms_mm, raw.rms_deg,
      raw.count);
  EXPECT_NEAR(mapped.clock.rate_hz, 120, 0.05);
  EXPECT_GT(mapped.clock.worst_lateness, 100 * kMillisecond) << "the recording has such stalls";
  EXPECT_LT(mapped.clock.fit_residual, 500 * kMicrosecond);
  EXPECT_LT(fitted.rms_mm, raw.rms_mm);
  EXPECT_LT(fitted.rms_deg, raw.rms_deg);
}

INSTANTIATE_TEST_SUITE_P(Recordings, RealLiberty,
                         ::testing::Combine(::testing::Values("tracker/liberty-two-sensors-a.csv",
                                                              "tracker/liberty-two-sensors-b.csv"),
                                            ::testing::Values(0, 1)));

}  // namespace
}  // namespace linescope
