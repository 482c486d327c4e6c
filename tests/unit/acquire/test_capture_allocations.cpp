// The daemon's real loop for live devices, from camera and LIBERTY to the segment: once it runs, neither a
// picture nor a sample allocates anything. Counted below operator new and OpenCV alike, in every thread.
//
// Not in it: libusb, which allocates one block for every transfer it hands to the kernel (usbfs), and the
// recorder's writing thread (its capture side is in test_record_allocation).
#include <gtest/gtest.h>
#include <malloc.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <deque>
#include <thread>

#include "acquire/acquisition.hpp"
#include "acquire/camera/device_camera.hpp"
#include "acquire/tracker/liberty/liberty_source.hpp"
#include "tests/integration/tracker/fake/fake_liberty.hpp"

extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
}

namespace {
std::atomic<bool> counting{false};
std::atomic<std::uint64_t> allocations{0};
void count_one() {
  if (counting.load(std::memory_order_relaxed)) allocations.fetch_add(1, std::memory_order_relaxed);
}
}  // namespace

extern "C" {
void* malloc(std::size_t size) {
  count_one();
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  count_one();
  return __libc_calloc(count, size);
}
void* realloc(void* block, std::size_t size) {
  count_one();
  return __libc_realloc(block, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  count_one();
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  return memalign(alignment, size);
}
int posix_memalign(void** block, std::size_t alignment, std::size_t size) {
  *block = memalign(alignment, size);
  return *block != nullptr ? 0 : ENOMEM;
}
}

namespace linescope {
namespace {

constexpr int kWidth = 720, kHeight = 480;
constexpr int kWarmUp = 120, kCounted = 300;

/// What the loop has done, so that the test knows when to count.
struct Progress {
  std::atomic<int> pictures{0};
  std::atomic<std::uint64_t> samples{0}, samples_at_begin{0};
};

/// A line that wanders over the picture; starts and ends the counting.
class LineDevice final : public CaptureDevice {
 public:
  LineDevice(Progress& progress, std::atomic<bool>& stop) : progress_(progress), stop_(stop) {
    for (int i = 0; i < 8; ++i) pictures_.push_back(line_picture(250 + 10 * i));
  }
  Result<OpenedDevice> open() override { return OpenedDevice{"a line", 5 * kMillisecond, {}}; }
  void close() override {}
  Result<void> set_exposure(double milliseconds) override {
    exposure_ms_ = milliseconds;
    return {};
  }
  Result<void> set_gain(double) override { return {}; }
  double exposure_ms() const override { return exposure_ms_; }

  Result<Pull> read(cv::Mat& bgr, Nanoseconds& stamp) override {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    const int n = progress_.pictures++;
    if (n == kWarmUp) {
      progress_.samples_at_begin = progress_.samples.load();
      counting = true;
    }
    if (n == kWarmUp + kCounted) {
      counting = false;
      stop_ = true;
    }
    pictures_[static_cast<std::size_t>(n) % pictures_.size()].copyTo(bgr);
    stamp = monotonic_now() - 4 * kMillisecond;
    return Pull::item;
  }

 private:
  static cv::Mat line_picture(int row) {
    cv::Mat picture(kHeight, kWidth, CV_8UC3, cv::Scalar(3, 3, 3));
    for (int u = 40; u < kWidth - 40; ++u)
      for (int d = -6; d <= 6; ++d)
        picture.at<cv::Vec3b>(row + d, u)[1] = static_cast<std::uint8_t>(180 * std::exp(-d * d / 8.0));
    return picture;
  }

  Progress& progress_;
  std::atomic<bool>& stop_;
  std::vector<cv::Mat> pictures_;
  double exposure_ms_ = 5;
};

/// The scripted unit answers while it is started; then eight sensors at 240 Hz from memory that is there
/// already.
class SteadyLine final : public ByteTransport {
 public:
  explicit SteadyLine(Progress& progress) : progress_(progress), unit_(8) {}
  Result<void> open() override { return {}; }
  void close() override {}
  Result<void> write(std::string_view bytes) override {
    unit_.receive({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    return {};
  }
  Result<Chunk> read(Nanoseconds) override { return unit_.streaming() ? steady() : conversation(); }
  void wait_for_change(Nanoseconds) override {}
  std::string description() const override { return "a steady line"; }
  std::string silence_hint() const override { return ""; }
  std::uint64_t faults() const override { return 0; }

 private:
  static constexpr std::size_t kRecord = 52;

  Chunk conversation() {
    const auto packet = unit_.next_packet();
    if (!packet) {
      std::this_thread::sleep_for(std::chrono::microseconds(200));
      return {};
    }
    packet_ = *packet;
    return {packet_, monotonic_now()};
  }
  Chunk steady() {
    if (cycle_.empty()) {
      unit_.run_cycles(1);
      cycle_ = *unit_.next_packet();
      begin_ = monotonic_now();
    }
    ++frame_;
    while (monotonic_now() < begin_ + frame_ * (kSecond / 240))
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    for (std::size_t at = 0; at + kRecord <= cycle_.size(); at += kRecord)
      std::memcpy(cycle_.data() + at + 8, &frame_, 4);  // the frame count is the first item
    progress_.samples += 8;
    return {cycle_, monotonic_now()};
  }

  Progress& progress_;
  testing::FakeLiberty unit_;
  std::vector<std::uint8_t> packet_, cycle_;
  std::uint32_t frame_ = 0;
  Nanoseconds begin_ = 0;
};

SegmentOptions segment_options() {
  SegmentOptions options;
  options.name = "linescope-unit-allocations-" + std::to_string(::getpid());
  options.line_capacity = 2000;
  options.points_per_line = kWidth;
  options.point_capacity = 2000 * kWidth;
  options.picture_bytes = kWidth * kHeight * 3;
  return options;
}

TEST(CaptureAllocations, TheCounterSeesAllocations) {
  counting = true;
  const cv::Mat picture(100, 100, CV_8UC3);
  const auto text = std::make_unique<std::string>(100, 'x');
  counting = false;
  EXPECT_GE(allocations.exchange(0), 3u);
}

TEST(CaptureAllocations, NonePerPictureAndSampleInTheRunningDaemon) {
  auto writer = SegmentWriter::create(segment_options());
  ASSERT_TRUE(writer) << writer.error().message;
  std::atomic<bool> stop{false};
  Progress progress;
  AcquireOptions options;
  options.camera.source = "test";
  options.tracker.source = "liberty";
  Sources sources;
  sources.camera = std::make_unique<DeviceCamera>(std::make_unique<LineDevice>(progress, stop));
  sources.tracker =
      std::make_unique<LibertySource>(options.tracker.liberty, std::make_unique<SteadyLine>(progress));
  sources.calibration = thesis_camera_ii();
  ASSERT_TRUE(sources.tracker->start());
  ASSERT_TRUE(sources.camera->start());
  auto acquisition = Acquisition::create(options, std::move(sources), *writer, stop);
  ASSERT_TRUE(acquisition) << acquisition.error().message;
  (*acquisition)->scan.start(monotonic_now());

  run_live(**acquisition);

  EXPECT_EQ(allocations.load(), 0u);
  EXPECT_GT(progress.samples - progress.samples_at_begin, 8u * 240u) << "a second of samples at least";
  EXPECT_GT(writer->lines_in_scan(), static_cast<std::uint32_t>(kCounted) / 2)
      << "pictures really became lines";
}

}  // namespace
}  // namespace linescope
