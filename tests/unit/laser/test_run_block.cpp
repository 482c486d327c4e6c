// Sums along eight runs at once are those of each run alone.
#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <random>

#include "acquire/laser/run_block.hpp"

namespace linescope {
namespace {

struct Case {
  int channels;
  ProfileAxis axis;
};

using Stretch = Run;  // testing::Test has a Run of its own

class RunBlockSums : public ::testing::TestWithParam<Case> {
 protected:
  /// Runs of all lengths in a noisy picture, also at its last pixel: whatever is bright in the first channel.
  void SetUp() override {
    if (!block_sums_known()) GTEST_SKIP() << "this processor has no such vectors";
    std::mt19937 generator(11);
    std::uniform_int_distribution<int> grey(0, 255), length(1, 75);
    picture_ = cv::Mat(101, 90, CV_MAKETYPE(CV_8U, GetParam().channels));
    for (int y = 0; y < picture_.rows; ++y)
      for (int i = 0; i < picture_.cols * GetParam().channels; ++i)
        picture_.ptr(y)[i] = static_cast<std::uint8_t>(grey(generator));
    view_ = {picture_.data, static_cast<std::ptrdiff_t>(picture_.step[0]), picture_.cols, picture_.rows,
             GetParam().channels};
    marks_ = cv::Mat::zeros(picture_.size(), CV_8UC3);
    const bool column = GetParam().axis == ProfileAxis::column;
    const int profiles = column ? marks_.cols : marks_.rows, pixels = column ? marks_.rows : marks_.cols;
    for (int p = 0; p < profiles; ++p) {
      const int n = length(generator), first = p % 5 == 0 ? pixels - n : (pixels - n) / 2;
      const cv::Rect run = column ? cv::Rect(p, first, 1, n) : cv::Rect(first, p, n, 1);
      if (p % 7 != 3) marks_(run).setTo(cv::Scalar::all(255));
    }
    MaskRule rule;
    rule.on = static_cast<unsigned>(LaserColour::mono);
    rule.ridge_threshold = 256;
    rule.axis = GetParam().axis;
    const PictureView marks{marks_.data, static_cast<std::ptrdiff_t>(marks_.step[0]), marks_.cols,
                            marks_.rows, 3};
    runs_.find(marks, rule, 0, &mark_picture, false);
  }

  /// Calls `compare(profile, run, block, lane)` for every run that a block holds; says how many.
  template <class Compare>
  void for_each_block(int lead, int& compared, Compare&& compare) {
    const int profiles = profile_count(view_, GetParam().axis);
    for (int from = 0; from < profiles; from += 3) {
      RunBlock block;
      block.begin(view_, GetParam().axis, lead);
      block.collect(runs_, from, kBlockLanes);
      for (int p = from; p < std::min(profiles, from + kBlockLanes); ++p) {
        const Stretch run = runs_.only_run(p);
        const auto lane = static_cast<std::size_t>(p - from);
        if (block.length[lane] == 0) continue;
        ASSERT_EQ(block.length[lane], run.length());
        compare(profile_of(view_, GetParam().axis, lead, p), run, block, lane);
        ++compared;
      }
    }
  }

  cv::Mat picture_, marks_;
  PictureView view_;
  RunFinder runs_;
};

constexpr std::array kColours{LaserColour::blue, LaserColour::green, LaserColour::red, LaserColour::cyan,
                              LaserColour::mono};

TEST_P(RunBlockSums, MeansAreThoseOfEachRun) {
  for (const LaserColour colour : kColours) {
    const ColourExcess excess(GetParam().channels == 1 ? LaserColour::mono : colour);
    const MeanLevels levels{40, 200};
    int n = 0;
    for_each_block(leading_channel(colour), n,
                   [&](const Profile& p, Stretch run, const RunBlock& block, std::size_t lane) {
                     RunMeanBlock means;
                     run_means(block, excess, levels, means);
                     const RunMean one = run_mean(p, run, excess, levels), laned = means.of(lane);
                     ASSERT_EQ(laned.before_end, one.before_end);
                     ASSERT_EQ(laned.sigma, one.sigma);
                     ASSERT_EQ(laned.peak, one.peak);
                     ASSERT_EQ(laned.saturated, one.saturated);
                   });
    EXPECT_GT(n, 130);
  }
}

TEST_P(RunBlockSums, OfLightAreThoseOfEachRun) {
  for (const LaserColour colour : kColours) {
    const ColourExcess excess(GetParam().channels == 1 ? LaserColour::mono : colour);
    int n = 0;
    for_each_block(leading_channel(colour), n,
                   [&](const Profile& p, Stretch run, const RunBlock& block, std::size_t lane) {
                     LightSumsBlock sums;
                     light_sums(block, excess, 60, sums);
                     const LightSums one = light_sums(p, run, excess, 60), laned = sums.of(lane);
                     ASSERT_EQ(laned.sum, one.sum);
                     ASSERT_EQ(laned.moment, one.moment);
                     ASSERT_EQ(laned.top, one.top);
                     ASSERT_EQ(laned.excess, one.excess);
                   });
    EXPECT_GT(n, 130);
  }
}

INSTANTIATE_TEST_SUITE_P(Pictures, RunBlockSums,
                         ::testing::Values(Case{3, ProfileAxis::column}, Case{3, ProfileAxis::row},
                                           Case{1, ProfileAxis::column}, Case{1, ProfileAxis::row}));

}  // namespace
}  // namespace linescope
