// The capture's side of the recorder and of the live camera allocates nothing per sample or picture, once
// warm.
#include <gtest/gtest.h>

#include <atomic>
#include <opencv2/core.hpp>

#include "acquire/camera/device_camera.hpp"
#include "acquire/record/recorder.hpp"
#include "tests/support/allocation_counter.hpp"
#include "tests/support/child_process.hpp"
#include "tests/unit/record/sample_data.hpp"

namespace {

/// Pictures' memory does not come from operator new.
class CountingMatAllocator final : public cv::MatAllocator {
 public:
  cv::UMatData* allocate(int dims, const int* sizes, int type, void* data, std::size_t* step,
                         cv::AccessFlag flags, cv::UMatUsageFlags usage) const override {
    ++count;
    return cv::Mat::getStdAllocator()->allocate(dims, sizes, type, data, step, flags, usage);
  }
  bool allocate(cv::UMatData* data, cv::AccessFlag flags, cv::UMatUsageFlags usage) const override {
    return cv::Mat::getStdAllocator()->allocate(data, flags, usage);
  }
  void deallocate(cv::UMatData* data) const override { cv::Mat::getStdAllocator()->deallocate(data); }

  mutable std::atomic<std::size_t> count{0};
};

CountingMatAllocator& mat_allocator() {
  static CountingMatAllocator allocator;
  return allocator;
}

}  // namespace

namespace linescope {
namespace {

class NoAllocation : public ::testing::Test {
 protected:
  NoAllocation() { cv::Mat::setDefaultAllocator(&mat_allocator()); }
  ~NoAllocation() override { cv::Mat::setDefaultAllocator(nullptr); }
};

TEST_F(NoAllocation, CountersSeeAllocations) {
  const std::size_t before = testing::allocations_here(), mats = mat_allocator().count;
  const std::vector<int> some(100, 1);
  const cv::Mat picture(10, 10, CV_8UC3);
  EXPECT_EQ(some.front(), 1);
  EXPECT_GT(testing::allocations_here(), before);
  EXPECT_GT(mat_allocator().count, mats);
}

TEST_F(NoAllocation, RecorderTakesPicturesAndSamplesIntoMemoryItHas) {
  const testing::TemporaryFolder folder;
  RecorderOptions options;
  options.folder = folder / "scan";
  options.keep_free = 0;
  options.picture_queue = 4;
  auto recorder = Recorder::start(options, testing::made_info());
  ASSERT_TRUE(recorder);
  Frame frame = testing::made_frame(1);
  const PoseSample sample = testing::made_sample(1);
  const auto give = [&](int count) {
    std::size_t allocated = 0;
    for (int i = 0; i < count; ++i) {
      const std::size_t before = testing::allocations_here();
      (*recorder)->add(frame);
      (*recorder)->add(sample);
      allocated += testing::allocations_here() - before;
      ++frame.index;
      while ((*recorder)->status().counters.pictures < frame.index) std::this_thread::yield();
    }
    return allocated;
  };
  frame.index = 0;
  give(8);  // every slot has held a picture
  const std::size_t mats = mat_allocator().count;
  EXPECT_EQ(give(100), 0U);
  EXPECT_EQ(mat_allocator().count, mats);
}

/// Gives the same picture for ever.
class EndlessDevice final : public CaptureDevice {
 public:
  Result<OpenedDevice> open() override { return OpenedDevice{"endless", 0, {}}; }
  void close() override {}
  Result<Pull> read(cv::Mat& bgr, Nanoseconds&) override {
    bgr.create(48, 64, CV_8UC3);
    return Pull::item;
  }
  Result<void> set_exposure(double) override { return {}; }
  Result<void> set_gain(double) override { return {}; }
};

TEST_F(NoAllocation, LiveCameraHandsItsPicturesRound) {
  DeviceCamera camera(std::make_unique<EndlessDevice>());
  ASSERT_TRUE(camera.start());
  Frame frame;
  const auto take = [&](int count) {
    for (int taken = 0; taken < count;) {
      const auto pull = camera.next(frame);
      ASSERT_TRUE(pull);
      taken += *pull == Pull::item ? 1 : 0;
    }
  };
  while (camera.status().counters.overrun < 20) std::this_thread::yield();
  take(20);
  const std::size_t mats = mat_allocator().count, before = testing::allocations_here();
  EXPECT_GT(mats, 0U) << "what the camera takes at first is counted";
  take(200);
  EXPECT_EQ(testing::allocations_here(), before);
  EXPECT_EQ(mat_allocator().count, mats);
}

}  // namespace
}  // namespace linescope
