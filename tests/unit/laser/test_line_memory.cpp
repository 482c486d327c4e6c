// Nothing is allocated per picture once the extractor has seen one like it.
#include <gtest/gtest.h>

#include "tests/support/allocation_counter.hpp"
#include "tests/unit/laser/line_scene.hpp"

namespace linescope {
namespace {

TEST(Memory, NothingIsAllocatedAfterTheFirstPicture) {
  for (const CentreMethod method : {CentreMethod::weighted_mean, CentreMethod::gauss_weighted}) {
    for (const ProfileAxis axis : {ProfileAxis::column, ProfileAxis::row}) {
      testing::LineScene scene;
      scene.axis = axis;
      scene.noise = 3;
      scene.stripes.push_back({testing::wave(80, 20, 120)});
      const cv::Mat busy = scene.draw();
      scene.noise = 2;
      scene.seed = 2;
      const cv::Mat next = scene.draw();
      LineExtractorOptions options;
      options.axis = axis;
      options.centre = method;
      LineExtractor extractor(options);
      extractor.extract(busy);
      const std::size_t before = testing::allocations_everywhere();
      const std::size_t found =
          extractor.extract(next).samples.size() + extractor.extract(busy).samples.size();
      EXPECT_EQ(testing::allocations_everywhere() - before, 0U);
      EXPECT_GT(before, 0U) << "the first picture is counted";
      EXPECT_GT(found, 300U);
    }
  }
}

}  // namespace
}  // namespace linescope
