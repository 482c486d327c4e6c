// Tip and axis of the tool: exact where the poses are exact, standard deviations that are those of many
// seeds, and wrong use refused with the reason.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/calibrate/tool_motion.hpp"
#include "tools/calibrate/block_fit.hpp"
#include "tools/calibrate/pivot_fit.hpp"
#include "tools/calibrate/spin_fit.hpp"

namespace linescope::calibrate {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

constexpr int kSeeds = 100;
constexpr PoseErrors kThesis{0.25, 0.0017};  // what the thesis cites of the LIBERTY: 0.25 mm, 0.1 degrees

TEST(Pivot, ExactPosesGiveTheExactTip) {
  const ToolTruth truth;
  const auto fit = fit_pivot(pivoting(400, {}));
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_LT((fit->tip - truth.tip).norm(), 1e-8);
  EXPECT_LT((fit->divot - truth.divot).norm(), 1e-8);
  EXPECT_LT(fit->residual_mm, 1e-9);
}

TEST(Pivot, StatedDeviationIsTheSpreadOverSeeds) {
  const ToolTruth truth;
  Vector3d squares = Vector3d::Zero(), stated = Vector3d::Zero();
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    const auto fit = fit_pivot(pivoting(600, {kThesis.position_mm, kThesis.rotation_rad, seed}));
    ASSERT_TRUE(fit);
    squares += (fit->tip - truth.tip).cwiseAbs2() / kSeeds;
    stated += fit->tip_covariance.diagonal() / kSeeds;
  }
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(std::sqrt(stated[k] / squares[k]), 1, 0.3) << k;
}

// A slip that lasts a tenth of a second moves 24 samples alike: counted as independent they would promise
// five times too much.
TEST(Pivot, StatedDeviationHoldsForSlipsThatLast) {
  const ToolTruth truth;
  Vector3d squares = Vector3d::Zero(), stated = Vector3d::Zero();
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    ToolPoses poses = pivoting(2400, {});
    std::mt19937_64 engine(seed);
    std::normal_distribution<double> normal;
    Vector3d slip = Vector3d::Zero();
    for (std::size_t i = 0; i < poses.size(); ++i) {
      if (i % 24 == 0) slip = 0.3 * Vector3d(normal(engine), normal(engine), normal(engine));
      auto& pose = poses[i].fixture_from_tool;
      pose = {pose.rotation(), pose.translation() + slip};
    }
    const auto fit = fit_pivot(poses);
    ASSERT_TRUE(fit);
    squares += (fit->tip - truth.tip).cwiseAbs2() / kSeeds;
    stated += fit->tip_covariance.diagonal() / kSeeds;
  }
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(std::sqrt(stated[k] / squares[k]), 1, 0.3) << k;
}

TEST(Pivot, ResidualAndHeldOutAreTheTipsScatter) {
  const auto fit = fit_pivot(pivoting(2000, {0.1, 0, 4}));
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->residual_mm, 0.1 * std::sqrt(3.0), 0.01);
  EXPECT_NEAR(fit->held_out_mm, 0.1 * std::sqrt(3.0), 0.01);
  EXPECT_GT(fit->held_out_mm, fit->residual_mm);
}

TEST(Pivot, PosesThatLeftTheDivotAreLeftOut) {
  ToolPoses poses = pivoting(600, {0.02, 0.0002, 7});
  for (std::size_t i = 200; i < 220; ++i) {
    auto& pose = poses[i].fixture_from_tool;
    pose = {pose.rotation(), pose.translation() + Vector3d(0, 4, 3)};
  }
  const auto fit = fit_pivot(poses);
  ASSERT_TRUE(fit);
  EXPECT_LT((fit->tip - ToolTruth{}.tip).norm(), 0.02);
  for (std::size_t i = 200; i < 220; ++i) {
    EXPECT_FALSE(fit->used[i]);
    EXPECT_NEAR(fit->error[i], 5, 0.3);
  }
}

TEST(Pivot, ToolThatIsNotMovedIsRefused) {
  const auto fit = fit_pivot(pivoting(600, kThesis, {}, {0, 0}));
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().code, ErrorCode::too_little_variation);
  EXPECT_THAT(fit.error().message, HasSubstr("the tool was not moved"));
}

TEST(Pivot, SwingAboutOneAxisOnlyIsRefused) {
  const auto fit = fit_pivot(pivoting(600, kThesis, {}, {0.6, 0}));
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().code, ErrorCode::too_little_variation);
  EXPECT_THAT(fit.error().message, HasSubstr("from side to side"));
}

TEST(Pivot, FewPosesOfAHiddenSensorAreRefused) {
  const auto fit = fit_pivot(pivoting(20, {}));
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().code, ErrorCode::too_few);
  EXPECT_THAT(fit.error().message, HasSubstr("20 good poses"));
}

TEST(Pivot, TipWithoutADivotIsAboveTheLimit) {
  const PivotOptions options;
  const auto fit = fit_pivot(pivoting(600, {1.5, 0, 2}), options);
  ASSERT_TRUE(fit);
  const auto limit = above_limit(*fit, options);
  ASSERT_FALSE(limit);
  EXPECT_EQ(limit.error().code, ErrorCode::above_limit);
}

TEST(Spin, ExactPosesGiveTheExactAxis) {
  const ToolTruth truth;
  const auto fit = fit_spin(spinning(600, {}));
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_LT(fit->axis.cross(truth.axis).norm(), 1e-9);
  EXPECT_LT(tip_beside_axis(*fit, truth.tip), 1e-7);
  EXPECT_NEAR(tip_beside_axis(*fit, truth.tip + 2 * truth.axis.unitOrthogonal()), 2, 1e-7);
}

TEST(Spin, StatedDeviationIsTheSpreadOverSeeds) {
  const ToolTruth truth;
  double squares = 0, stated = 0;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    const auto fit = fit_spin(spinning(600, {kThesis.position_mm, kThesis.rotation_rad, seed}));
    ASSERT_TRUE(fit);
    squares += 0.5 * fit->axis.cross(truth.axis).squaredNorm() / kSeeds;
    stated += fit->axis_deviation_rad * fit->axis_deviation_rad / kSeeds;
  }
  EXPECT_NEAR(std::sqrt(stated / squares), 1, 0.3);
}

TEST(Spin, TheAxisPointsFromTheTipToTheHandle) {
  const ToolTruth truth;
  EXPECT_GT(oriented_axis(-truth.axis, truth.tip, {0, 0, 1}).dot(truth.axis), 0);
  // The tip is not known yet: as before.
  EXPECT_GT(oriented_axis(truth.axis, Vector3d::Zero(), -truth.axis).dot(-truth.axis), 0);
}

TEST(Spin, ToolThatIsNotTurnedIsRefused) {
  const auto fit = fit_spin(spinning(600, kThesis, {}, 0.0));
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().code, ErrorCode::too_little_variation);
}

TEST(Spin, TiltedInsteadOfTurnedIsAboveTheLimit) {
  const SpinOptions options;
  const auto fit = fit_spin(pivoting(600, {}, {}, {1.2, 0.9}), options);
  ASSERT_TRUE(fit);
  EXPECT_EQ(above_limit(*fit, options).error().code, ErrorCode::above_limit);
}

TEST(Block, KnownHoleGivesTipAndAxisAtOnce) {
  const ToolTruth truth;
  BlockOptions options;
  options.tip = truth.divot;
  options.axis = 3 * (leaning(0.3, -0.2) * truth.axis);
  const auto fit = fit_block(spinning(600, {0.02, 0.0002, 3}), options);
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_LT((fit->tip - truth.tip).norm(), 0.01);
  EXPECT_LT(fit->axis.cross(truth.axis).norm(), 1e-4);
  EXPECT_TRUE(above_limit(*fit, options));
}

TEST(Block, StatedDeviationIsTheSpreadOverSeeds) {
  const ToolTruth truth;
  BlockOptions options;
  options.tip = truth.divot;
  options.axis = leaning(0.3, -0.2) * truth.axis;
  Vector3d squares = Vector3d::Zero(), stated = Vector3d::Zero();
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    const auto fit = fit_block(spinning(300, {kThesis.position_mm, kThesis.rotation_rad, seed}), options);
    ASSERT_TRUE(fit);
    squares += (fit->tip - truth.tip).cwiseAbs2() / kSeeds;
    stated += fit->tip_deviation.cwiseAbs2() / kSeeds;
  }
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(std::sqrt(stated[k] / squares[k]), 1, 0.3) << k;
}

TEST(Block, ToolTakenOutOfTheHoleIsAboveTheLimit) {
  BlockOptions options;
  options.tip = ToolTruth{}.divot;
  options.axis = leaning(0.3, -0.2) * ToolTruth{}.axis;
  const auto fit = fit_block(pivoting(600, {}), options);
  ASSERT_TRUE(fit);
  EXPECT_EQ(above_limit(*fit, options).error().code, ErrorCode::above_limit);
}

TEST(ToolOptions, LimitsThatCannotBeAreRefused) {
  EXPECT_TRUE(validate(PivotOptions{}));
  EXPECT_TRUE(validate(SpinOptions{}));
  EXPECT_TRUE(validate(BlockOptions{}));
  EXPECT_FALSE(validate(PivotOptions{.least_poses = 3}));
  EXPECT_FALSE(validate(SpinOptions{.most_wobble_deg = 0}));
  EXPECT_FALSE(validate(BlockOptions{.axis = Vector3d::Zero()}));
}

}  // namespace
}  // namespace linescope::calibrate
