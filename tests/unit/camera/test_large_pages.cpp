// Pictures on large pages: what the kernel says of their memory, and that a cv::Mat works as with any other.
#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/core.hpp>
#include <sstream>
#include <string>

#include "acquire/camera/large_pages.hpp"

namespace linescope {
namespace {

cv::Mat on_large_pages(int rows, int columns) {
  cv::Mat picture;
  picture.allocator = &large_pages();
  picture.create(rows, columns, CV_8UC3);
  return picture;
}

/// The line "VmFlags" that the kernel keeps for the memory in which an address lies.
std::string kernel_flags(const void* address) {
  const auto wanted = reinterpret_cast<std::uintptr_t>(address);
  std::ifstream maps("/proc/self/smaps");
  bool inside = false;
  for (std::string line; std::getline(maps, line);) {
    std::istringstream head(line);
    std::uintptr_t begin = 0, end = 0;
    char dash = 0;
    if (head >> std::hex >> begin >> dash >> end && dash == '-') inside = begin <= wanted && wanted < end;
    if (inside && line.rfind("VmFlags:", 0) == 0) return line + " ";
  }
  return {};
}

TEST(LargePages, TheKernelIsAskedForThem) {
  if (!std::ifstream("/sys/kernel/mm/transparent_hugepage/enabled"))
    GTEST_SKIP() << "this kernel knows no transparent large pages";
  const cv::Mat picture = on_large_pages(480, 640);
  EXPECT_NE(kernel_flags(picture.data).find(" hg "), std::string::npos) << kernel_flags(picture.data);
  EXPECT_NE(kernel_flags(picture.data + 480 * 640 * 3 - 1).find(" hg "), std::string::npos)
      << "its last byte";
}

TEST(LargePages, APictureIsAsAnyOther) {
  cv::Mat picture = on_large_pages(480, 640);
  EXPECT_TRUE(picture.isContinuous());
  EXPECT_EQ(picture.step[0], 640U * 3);
  EXPECT_EQ(picture.elemSize(), 3U);
  cv::randu(picture, 0, 256);
  const cv::Mat shared = picture, own = picture.clone();
  const uchar* memory = picture.data;
  picture.create(480, 640, CV_8UC3);
  EXPECT_EQ(picture.data, memory) << "the same size keeps its memory";
  picture.create(600, 800, CV_8UC3);
  EXPECT_NE(picture.data, memory);
  EXPECT_EQ(cv::norm(shared, own, cv::NORM_INF), 0) << "whoever shared the pixels still has them";
}

TEST(LargePages, SmallOnesAndOtherPeoplesMemoryAreLeftToOpenCV) {
  EXPECT_EQ(on_large_pages(16, 16).u->currAllocator, cv::Mat::getStdAllocator());
  EXPECT_EQ(on_large_pages(480, 640).u->currAllocator, &large_pages());
  EXPECT_TRUE(on_large_pages(0, 0).empty());
}

TEST(LargePages, NoMemoryIsAnExceptionOfOpenCV) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers end the program that asks for so much";
#endif
  cv::Mat picture;
  picture.allocator = &large_pages();
  const int sizes[] = {1 << 20, 1 << 20, 1 << 10};
  EXPECT_THROW(picture.create(3, sizes, CV_8UC3), cv::Exception);
}

}  // namespace
}  // namespace linescope
