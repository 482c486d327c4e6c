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
    const std::size_t bytes = laid_out(dims, sizes, type, data == nullptr ? step : nullptr);
    if (data != nullptr || bytes < kPage / 4)
      return cv::Mat::getDefaultAllocator()->allocate(dims, sizes, type, data, step, access, usage);
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
  /// Bytes of a picture without gaps; the steps of its dimensions go to `step` where that is wanted.
  static std::size_t laid_out(int dims, const int* sizes, int type, std::size_t* step) {
    std::size_t bytes = CV_ELEM_SIZE(type);
    for (int i = dims - 1; i >= 0; --i) {
      if (step != nullptr) step[i] = bytes;
      bytes *= static_cast<std::size_t>(sizes[i]);
    }
    return bytes;
  }
};

}  // namespace

cv::MatAllocator& large_pages() {
  static LargePages* const pages = new LargePages;  // never deleted: a picture may outlive every static
  return *pages;
}

}  // namespace linescope
