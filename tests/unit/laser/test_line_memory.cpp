// Nothing is allocated per picture once the extractor has seen one like it.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "tests/unit/laser/line_scene.hpp"

namespace {
std::atomic<long> allocations{0};
}

[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* p = std::malloc(size)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* p) noexcept {
  std::free(p);
}
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept {
  std::free(p);
}

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
      const long before = allocations;
      const std::size_t found =
          extractor.extract(next).samples.size() + extractor.extract(busy).samples.size();
      EXPECT_EQ(allocations - before, 0);
      EXPECT_GT(found, 300U);
    }
  }
}

}  // namespace
}  // namespace linescope
