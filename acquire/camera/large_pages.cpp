#include "acquire/camera/large_pages.hpp"

#include <fmt/format.h>
#include <sys/mman.h>

#include <cstdlib>
#include <memory>

namespace linescope {
namespace {

constexpr std::size_t kPage = std::size_t{2} << 20;  // of x86-64, and of ARM with pages of 4 KiB

void* whole_pages(std::size_t bytes) {
  const std::size_t size = (bytes + kPage - 1) / kPage * kPage;
  void* memory = std::aligned_alloc(kPage, size);
  if (memory == nullptr)
    CV_Error(cv::Error::StsNoMem, fmt::format("no memory for a picture of {} bytes", bytes));
  ::madvise(memory, size, MADV_HUGEPAGE);  // a wish: refused, it is memory as any other
  return memory;
}

class LargePages final : public cv::MatAllocator {
 public:
  cv::UMatData* allocate(int dims, const int* sizes, int type, void* data, std::size_t* step,
                         cv::AccessFlag access, cv::UMatUsageFlags usage) const override {
    std::size_t bytes = CV_ELEM_SIZE(type);
    for (int i = 0; i < dims; ++i) bytes *= static_cast<std::size_t>(sizes[i]);
    if (data != nullptr || bytes < kPage / 4)
      return cv::Mat::getDefaultAllocator()->allocate(dims, sizes, type, data, step, access, usage);
    set_steps(dims, sizes, type, step);
    auto picture = std::make_unique<cv::UMatData>(this);
    picture->data = picture->origdata = static_cast<uchar*>(whole_pages(bytes));
    picture->size = bytes;
    return picture.release();
  }

  bool allocate(cv::UMatData* data, cv::AccessFlag, cv::UMatUsageFlags) const override {
    return data != nullptr;
  }

  void deallocate(cv::UMatData* picture) const override {
    std::free(picture->origdata);
    delete picture;
  }

 private:
  static void set_steps(int dims, const int* sizes, int type, std::size_t* step) {
    if (step == nullptr) return;
    std::size_t bytes = CV_ELEM_SIZE(type);
    for (int i = dims - 1; i >= 0; --i) {
      step[i] = bytes;
      bytes *= static_cast<std::size_t>(sizes[i]);
    }
  }
};

}  // namespace

cv::MatAllocator& large_pages() {
  static LargePages* const pages = new LargePages;  // never deleted: a picture may outlive every static
  return *pages;
}

}  // namespace linescope
