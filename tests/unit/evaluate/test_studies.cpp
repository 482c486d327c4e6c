// The studies themselves, small: one set of noise parameters lands near the thesis's figures.
#include <gtest/gtest.h>

#include <cmath>

#include "common/units.hpp"
#include "tools/evaluate/navigation_study.hpp"
#include "tools/evaluate/plane_study.hpp"
#include "tools/evaluate/sections.hpp"
#include "tools/evaluate/setups.hpp"

namespace linescope::evaluate {
namespace {

const Form kSmall{.seeds = 2, .scan_seconds = 0.6, .spots = 30, .jobs = 2};

// Table 4.1 prints 0.25 and 0.26 mm at 14 and 16 mm. Ours is 0.36 (docs/evaluation.md: somewhat too much, and
// nothing is tuned for this table); the bounds hold it near.
TEST(PlaneStudy, ThesisNoiseGivesASpreadNearTheThesiss) {
  const PlaneStudy study{"plane", "", {{14, 0.38, 0.25}, {16, 0.27, 0.26}}, {}, {}, system_ii};
  const auto table = plane_table(study, kSmall);
  ASSERT_TRUE(table) << table.error().message;
  for (const std::size_t row : {1u, 4u}) {
    const Estimate e = *table->rows[row].plain;
    EXPECT_EQ(e.count, 2);
    EXPECT_GT(e.mean, 0.2) << table->rows[row].what;
    EXPECT_LT(e.mean, 0.4) << table->rows[row].what;
  }
}

TEST(PlaneStudy, BentSheetSpreadsMoreThanTheFlatOne) {
  const auto spread = [](auto instrument) {
    const PlaneStudy study{"plane", "", {{20, {}, {}}}, {}, {}, instrument};
    return plane_table(study, kSmall)->rows[1].better->mean;
  };
  const double flat = spread([](std::uint64_t seed) { return system_ii(seed); });
  const double bent = spread([](std::uint64_t seed) { return with_bent_sheet(system_ii(seed)); });
  EXPECT_GT(bent, 1.5 * flat);
}

// The thesis's 9.5 degrees are of this size; docs/evaluation.md says by how much ours differ. The robust
// estimate must beat Algorithm 1.
TEST(NavigationStudy, RobustEstimateBeatsAlgorithmOne) {
  const Form form{.seeds = 1, .scan_seconds = 2.0, .spots = 30, .jobs = 1};
  const auto outcome = navigation_experiment(form, 1);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->plain.asked, 30);
  EXPECT_GE(outcome->plain.answered, 25);
  EXPECT_GT(degrees_from_radians(outcome->plain.mean), 5.0);
  EXPECT_LT(outcome->better.mean, 0.6 * outcome->plain.mean);
}

TEST(PrismSection, ReproducesTable33) {
  const auto sections = prism_sections(kSmall);
  ASSERT_TRUE(sections);
  const auto& rows = sections->front().table.rows;
  ASSERT_EQ(rows.size(), 8u);
  // n_w 1.33 gives the printed apex angles, n_w 1.333 the printed critical angles.
  EXPECT_NEAR(rows[0].plain->mean, 58.20, 0.005);
  EXPECT_NEAR(rows[3].plain->mean, 63.46, 0.005);
  EXPECT_NEAR(rows[4].plain->mean, 53.35, 0.015);
  EXPECT_NEAR(rows[7].plain->mean, 60.60, 0.005);
}

TEST(ForEachSeed, KeepsTheOrderAndReportsTheFirstFailure) {
  const Form form{.seeds = 7, .jobs = 3};
  const auto squares = for_each_seed<int>(
      form, [](std::uint64_t seed) -> Result<int> { return static_cast<int>(seed * seed); });
  EXPECT_EQ(*squares, (std::vector<int>{1, 4, 9, 16, 25, 36, 49}));
  const auto failed = for_each_seed<int>(form, [](std::uint64_t seed) -> Result<int> {
    if (seed >= 3) return fail(ErrorCode::invalid, "seed " + std::to_string(seed));
    return 0;
  });
  EXPECT_EQ(failed.error().message, "seed 3");
}

}  // namespace
}  // namespace linescope::evaluate
