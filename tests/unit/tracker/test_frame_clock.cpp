#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "acquire/tracker/frame_clock.hpp"
#include "acquire/tracker/frame_sequence.hpp"

namespace linescope {
namespace {

constexpr double kTrueHz = 240.00469;  // a real unit, measured over four hours
constexpr Nanoseconds kStart = 50 * kSecond;

Nanoseconds measured_at(std::int64_t frame) {
  return kStart + static_cast<Nanoseconds>(std::llround(static_cast<double>(frame) * 1e9 / kTrueHz));
}

/// Arrivals as they are: 3.5 ms of processing, a bus with an exponential delay, now and then a stall during
/// which everything waits for its end.
class Arrivals {
 public:
  explicit Arrivals(double mean_delay_ms) : delay_(1 / (mean_delay_ms * 1e6)) {}
  Nanoseconds operator()(std::int64_t frame) {
    Nanoseconds arrival = measured_at(frame) + 3'500'000 + static_cast<Nanoseconds>(delay_(random_));
    if (arrival < stalled_until_)
      arrival = stalled_until_;
    else if (std::uniform_int_distribution(0, 2000)(random_) == 0)
      stalled_until_ = arrival + 237 * kMillisecond;
    last_ = std::max(last_, arrival);
    return last_;
  }

 private:
  std::mt19937_64 random_{7};
  std::exponential_distribution<double> delay_;
  Nanoseconds stalled_until_ = 0;
  Nanoseconds last_ = 0;
};

TEST(FrameClock, FindsTheTimeOfMeasurementBehindJitterAndStalls) {
  FrameClock clock;
  Arrivals arrival(0.3);
  double worst = 0;
  double worst_raw = 0;
  Nanoseconds longest_stall = 0;
  for (std::int64_t frame = 1000; frame < 1000 + 240 * 60; ++frame) {
    const Nanoseconds t = arrival(frame);
    clock.observe(frame, t);
    if (frame % 240 == 0) longest_stall = std::max(longest_stall, clock.figures().worst_lateness);
    if (frame < 1000 + 240 * 10) continue;
    worst = std::max(worst, std::abs(static_cast<double>(clock.time_of(frame) - measured_at(frame))));
    worst_raw = std::max(worst_raw, std::abs(static_cast<double>(t - 3'500'000 - measured_at(frame))));
  }
  EXPECT_LT(worst, 100'000);          // 0.1 ms: a fortieth of a cycle
  EXPECT_GT(worst_raw, 200'000'000);  // and the raw arrivals really were that bad
  const FrameClockFigures figures = clock.figures();
  EXPECT_NEAR(figures.rate_hz, kTrueHz, 0.002);
  EXPECT_NEAR(milliseconds_from(longest_stall), 237, 10);
  EXPECT_EQ(figures.blocks, 100);
}

TEST(FrameClock, IsExactOnExactArrivals) {
  FrameClock clock({.nominal_hz = 240, .latency = 0});
  for (std::int64_t frame = 0; frame < 240 * 20; ++frame) clock.observe(frame, measured_at(frame));
  for (const std::int64_t frame : {0, 2000, 4799, 4850})
    EXPECT_NEAR(static_cast<double>(clock.arrival_of(frame) - measured_at(frame)), 0, 100);
  EXPECT_NEAR(clock.figures().rate_hz, kTrueHz, 1e-6);
}

TEST(FrameClock, WorksFromTheFirstFrame) {
  FrameClock clock;
  EXPECT_FALSE(clock.running());
  clock.observe(77, 10 * kSecond);
  EXPECT_TRUE(clock.running());
  EXPECT_EQ(clock.time_of(77), 10 * kSecond - 3'500'000);
  EXPECT_EQ(clock.figures().rate_hz, 240);
}

TEST(FrameClock, AnUnknownRateIsFoundAsWell) {
  // Set to 120 by somebody, while we believe 120.0: the recordings show up to 120.3.
  FrameClock clock({.nominal_hz = 120, .latency = 0});
  for (std::int64_t frame = 0; frame < 120 * 10; ++frame)
    clock.observe(frame, static_cast<Nanoseconds>(static_cast<double>(frame) * 1e9 / 120.3));
  EXPECT_NEAR(clock.figures().rate_hz, 120.3, 1e-3);
}

TEST(FrameClock, OptionsAreChecked) {
  EXPECT_TRUE(validate(FrameClockOptions{}));
  EXPECT_FALSE(validate({.nominal_hz = 0, .latency = 0}));
  EXPECT_FALSE(validate({.nominal_hz = 240, .latency = -1}));
}

class FrameSequenceTest : public ::testing::Test {
 protected:
  using Verdict = FrameSequence::Verdict;
  /// The record of that count arrives when its time has come.
  Verdict arrive(std::uint32_t count, Nanoseconds arrival) { return sequence.accept(count, arrival, frame); }

  FrameSequence sequence{{.nominal_hz = 240, .latency = 0}};
  std::int64_t frame = 0;
};

TEST_F(FrameSequenceTest, RollsOverAtTwoToTheThirtyTwo) {
  arrive(0xfffffffe, kStart);
  const std::int64_t first = frame;
  EXPECT_EQ(arrive(0xffffffff, kStart + 4'166'667), Verdict::believed);
  EXPECT_EQ(arrive(0, kStart + 8'333'333), Verdict::believed);
  EXPECT_EQ(arrive(1, kStart + 12'500'000), Verdict::believed);
  EXPECT_EQ(frame, first + 3);
}

TEST_F(FrameSequenceTest, ACountFromTheFutureIsDroppedAndTheStreamGoesOn) {
  for (std::uint32_t i = 0; i < 100; ++i) arrive(i, measured_at(i));
  EXPECT_EQ(arrive(500'000, measured_at(100)), Verdict::doubtful);
  EXPECT_EQ(arrive(100, measured_at(100)), Verdict::believed);
  EXPECT_EQ(frame, 100);
}

TEST_F(FrameSequenceTest, AGapThatTookItsTimeIsBelieved) {
  for (std::uint32_t i = 0; i < 100; ++i) arrive(i, measured_at(i));
  EXPECT_EQ(arrive(5000, measured_at(5000)), Verdict::believed);
  EXPECT_EQ(frame, 5000);
}

TEST_F(FrameSequenceTest, ACounterThatBeganAnewIsRecognisedAfterThreeRecords) {
  for (std::uint32_t i = 1000; i < 2000; ++i) arrive(i, measured_at(i));
  EXPECT_EQ(arrive(1, measured_at(2000)), Verdict::doubtful);
  EXPECT_EQ(arrive(2, measured_at(2001)), Verdict::doubtful);
  EXPECT_EQ(arrive(3, measured_at(2002)), Verdict::new_epoch);
  EXPECT_EQ(frame, 2000);
  EXPECT_EQ(arrive(4, measured_at(2003)), Verdict::believed);
  EXPECT_EQ(frame, 2001);
}

}  // namespace
}  // namespace linescope
