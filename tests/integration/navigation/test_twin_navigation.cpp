// The thesis's 30 spots on the 50 mm cylinder through the whole chain of the twin, a share of it: the long
// run is tools/studies/navigation_study (docs/navigation.md).
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "tools/studies/navigation_study.hpp"

namespace linescope::study {
namespace {

StudyCondition condition(const std::string& name) {
  for (const StudyCondition& c : navigation_conditions())
    if (c.name == name) return c;
  ADD_FAILURE() << "no condition is called " << name;
  return {};
}

class TwinNavigation : public testing::Test {
 protected:
  NavigationRow run(const std::string& name, int seeds) {
    NavigationStudyOptions options;
    options.seeds = seeds;
    const auto row = run_navigation_study(condition(name), options);
    EXPECT_TRUE(row) << row.error().message;
    if (!row) return {};
    std::printf("%s", navigation_table_line(*row).c_str());
    return *row;
  }
};

TEST_F(TwinNavigation, WithTheThesissNoiseOursIsBelowOneDegreeAndAlgorithm1IsWhereTheThesisWas) {
  const NavigationRow row = run("cylinder 50 mm, poses interpolated", 2);
  EXPECT_EQ(row.robust.asked, 60);
  EXPECT_GE(row.robust.answered(), 54) << refusals_text(row.robust);
  const ErrorSummary ours = summary(row.robust.normal_error), thesis = summary(row.algorithm_1.normal_error);
  EXPECT_LE(ours.mean, 1.0);
  EXPECT_LE(ours.percentile_95, 2.5);
  // The thesis: 9.5 degrees on average, single spots from 5 to 17.
  EXPECT_GE(thesis.mean, 5);
  EXPECT_LE(thesis.mean, 17);
}

TEST_F(TwinNavigation, MeanPosesHalveTheError) {
  const NavigationRow alone = run("cylinder 50 mm, poses interpolated", 1);
  const NavigationRow mean = run("cylinder 50 mm, four sweeps", 1);
  EXPECT_LT(summary(mean.algorithm_1.normal_error).mean, 0.6 * summary(alone.algorithm_1.normal_error).mean);
  EXPECT_LT(summary(mean.robust.normal_error).mean, 0.5);
}

TEST_F(TwinNavigation, AGapTheLineCannotBeSeenAtIsRefusedWithTheTwinsSentence) {
  StudyCondition near = condition("cylinder 50 mm, four sweeps");
  near.twin.hand.gap_mm = 6.5;
  const auto row = run_navigation_study(near, {});
  ASSERT_FALSE(row);
  EXPECT_NE(row.error().message.find("out of the picture"), std::string::npos);
}

}  // namespace
}  // namespace linescope::study
