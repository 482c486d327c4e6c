// The evaluation's statistics against printed figures and tables.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tools/evaluate/statistics.hpp"

namespace linescope::evaluate {
namespace {

// Section 5.3.2 of the thesis: 9.5 (SD 2.86, N 30) against two freehand groups of 20; printed P = 0.001 and
// 0.0024. By hand: pooled SD 5.212 and 3.348, t = 5.3 / (5.212 sqrt(1/30 + 1/20)) and 3.1 / (3.348 ...).
TEST(PooledStudent, ReproducesTheThesissP) {
  const GroupSummary navigated{9.5, 2.86, 30};
  const StudentTest harvest = pooled_student(navigated, {14.8, 7.53, 20});
  const StudentTest recipient = pooled_student(navigated, {12.6, 3.98, 20});
  EXPECT_EQ(harvest.degrees_of_freedom, 48);
  EXPECT_NEAR(harvest.t, -3.508, 0.003);
  EXPECT_NEAR(harvest.p, 0.00099, 0.00001);
  EXPECT_NEAR(recipient.t, -3.207, 0.003);
  EXPECT_NEAR(recipient.p, 0.0024, 0.00005);
}

// Welch's test would give 0.0064 and 0.0051: the difference must be visible.
TEST(PooledStudent, IsNotWelchs) {
  EXPECT_LT(pooled_student({9.5, 2.86, 30}, {14.8, 7.53, 20}).p, 0.003);
}

TEST(PooledStudent, SameMeansAreNoDifference) {
  EXPECT_DOUBLE_EQ(pooled_student({3, 1, 10}, {3, 2, 12}).p, 1);
}

// Student's table: 2.776 for four degrees of freedom.
TEST(Estimate, IntervalIsStudents) {
  const auto e = estimate({1, 2, 3, 4, 5});
  ASSERT_TRUE(e);
  EXPECT_DOUBLE_EQ(e->mean, 3);
  EXPECT_DOUBLE_EQ(e->deviation, std::sqrt(2.5));
  EXPECT_NEAR(e->half_width, 2.776 * std::sqrt(2.5 / 5), 0.001);
  EXPECT_EQ(e->count, 5);
}

TEST(Estimate, OneValueHasNoIntervalAndNoValueNoEstimate) {
  EXPECT_TRUE(std::isinf(estimate({7})->half_width));
  EXPECT_FALSE(estimate({}));
  EXPECT_FALSE(estimate({std::numeric_limits<double>::quiet_NaN()}));
}

TEST(Estimate, LeavesOutWhatIsNoNumber) {
  const auto e = estimate({1, std::numeric_limits<double>::quiet_NaN(), 3});
  EXPECT_EQ(e->count, 2);
  EXPECT_DOUBLE_EQ(e->mean, 2);
}

// The interval of one more value is wider than that of the mean: 2.776 sqrt(1 + 1/5) SD.
TEST(CouldBe, IsThePredictionInterval) {
  const Estimate e = *estimate({1, 2, 3, 4, 5});
  const double width = 2.776 * std::sqrt(2.5 * 1.2);
  EXPECT_TRUE(could_be(e, 3 + 0.99 * width));
  EXPECT_FALSE(could_be(e, 3 + 1.01 * width));
  EXPECT_GT(width, e.half_width);
}

TEST(Box, QuartilesOfAKnownSample) {
  const Box b = box_of({9, 1, 5, 3, 7});
  EXPECT_EQ(b.low, 1);
  EXPECT_EQ(b.quarter, 3);
  EXPECT_EQ(b.median, 5);
  EXPECT_EQ(b.three_quarters, 7);
  EXPECT_EQ(b.high, 9);
}

}  // namespace
}  // namespace linescope::evaluate
