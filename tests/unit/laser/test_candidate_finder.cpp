// Candidates of profiles taken several at a time are those of profiles taken one by one.
#include <gtest/gtest.h>

#include "acquire/laser/candidate_finder.hpp"
#include "tests/unit/laser/line_scene.hpp"

namespace linescope {
namespace {

struct Found {
  CandidateList candidates;
  float noise = 0;
};

Found find(const cv::Mat& m, const LineExtractorOptions& options, bool at_once) {
  const PictureView picture{m.data, static_cast<std::ptrdiff_t>(m.step[0]), m.cols, m.rows, 3};
  RunFinder runs;
  runs.find(picture, mask_rule(options, 3), options.merge_gap, &mark_picture, true);
  CandidateFinder finder(options, at_once);
  NoiseMeter noise;
  Found found;
  const auto& scene = runs.ambient();
  finder.begin(options.colour, {scene[1], scene[2], scene[0]});
  finder.find(picture, runs, found.candidates, noise);
  found.noise = noise.sigma();
  return found;
}

/// A line with steps, a gap, a saturated stretch and a rival, between specks of noise.
cv::Mat busy_picture(ProfileAxis axis) {
  testing::LineScene scene;
  scene.axis = axis;
  scene.width = scene.height = 240;
  scene.noise = 7;
  scene.stripes.push_back({testing::wave(80, 30, 170), 2.0, 110, 0.1, 0, 90});
  scene.stripes.push_back({testing::wave(70, 8, 60), 2.5, 140, 0.2, 97, 160});
  scene.stripes.push_back({testing::wave(90, 20, 50), 3.0, 600, 0.3, 161, 200});
  scene.stripes.push_back({testing::wave(150, 0, 1), 1.5, 60, 0, 40, 120});
  return scene.draw();
}

TEST(CandidateFinder, SeveralProfilesAtATimeGiveWhatEachGivesAlone) {
  if (!block_sums_known()) GTEST_SKIP() << "this processor has no such vectors";
  for (const ProfileAxis axis : {ProfileAxis::column, ProfileAxis::row}) {
    for (const CentreMethod method : {CentreMethod::weighted_mean, CentreMethod::gauss_weighted}) {
      LineExtractorOptions options;
      options.axis = axis;
      options.centre = method;
      const cv::Mat picture = busy_picture(axis);
      const Found several = find(picture, options, true), alone = find(picture, options, false);
      EXPECT_EQ(several.noise, alone.noise);
      EXPECT_EQ(several.candidates.first, alone.candidates.first);
      ASSERT_EQ(several.candidates.all.size(), alone.candidates.all.size());
      EXPECT_GT(several.candidates.all.size(), 240U);
      for (std::size_t i = 0; i < several.candidates.all.size(); ++i) {
        const Candidate &a = several.candidates.all[i], &b = alone.candidates.all[i];
        EXPECT_EQ(a.profile, b.profile);
        EXPECT_EQ(a.centre, b.centre) << "profile " << a.profile;
        EXPECT_EQ(a.sigma, b.sigma);
        EXPECT_EQ(a.peak, b.peak);
        EXPECT_EQ(a.saturated, b.saturated);
        EXPECT_EQ(a.look, b.look);
        EXPECT_EQ(a.clipped, b.clipped);
        EXPECT_EQ(a.good, b.good);
        EXPECT_EQ(a.fault, b.fault);
      }
    }
  }
}

}  // namespace
}  // namespace linescope
