// After create() the writer allocates nothing and takes no lock, whatever it publishes.
#include <dlfcn.h>
#include <pthread.h>

#include <mutex>

#include "tests/support/allocation_counter.hpp"
#include "tests/unit/ipc/segment_fixture.hpp"

namespace {

thread_local std::size_t locks_here = 0;

}  // namespace

/// Stands before the C library's own.
extern "C" int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  using Lock = int (*)(pthread_mutex_t*);
  static const auto lock = reinterpret_cast<Lock>(::dlsym(RTLD_NEXT, "pthread_mutex_lock"));
  ++locks_here;
  return lock(mutex);
}

namespace linescope::testing {
namespace {

class WriterCost : public SegmentTest {
 protected:
  WriterCost() {
    for (std::size_t i = 0; i < samples_.size(); ++i) samples_[i].u = static_cast<float>(i);
  }
  /// Everything a daemon publishes, also what is refused.
  void publish_everything() {
    writer_->set_scanning(true);
    for (int i = 0; i < 60; ++i) writer_->publish_line(info_, points_);  // more than there is room for
    writer_->undo_to(3);
    writer_->begin_scan(monotonic_now());
    writer_->publish_picture(picture_, pixels_.data(), 64 * 3, samples_);
    writer_->set_camera_status(camera_);
    for (std::uint8_t station = 0; station <= kMaxStations; ++station) {
      pose_.station = station;
      writer_->publish_pose(pose_);
      writer_->set_sensor_status(station, sensor_);
    }
    writer_->set_state(DaemonState::scanning, "a sentence that is longer than any small string");
    writer_->publish_configuration("[camera]\nwidth = 160\nheight = 120\nname = \"a camera\"\n");
    writer_->publish_calibration("%YAML:1.0\n---\nfocal_length_of_the_camera: 500\n");
    writer_->count(Counter::frames_received);
    writer_->record_latency(LatencyStage::extract, 1000);
    ASSERT_TRUE(writer_->heartbeat(monotonic_now()));
  }

  const ScanLineInfo info_ = info_for(1);
  const std::vector<SurfacePoint> points_ = points_for(1, 33);
  const std::vector<std::byte> pixels_ = std::vector<std::byte>(64 * 48 * 3);
  std::vector<PictureSample> samples_ = std::vector<PictureSample>(40);
  const PictureInfo picture_{.width = 64, .height = 48, .name = "a picture of a long file name.png"};
  CameraReport camera_;
  SensorStatus sensor_;
  PoseSample pose_;
};

TEST_F(WriterCost, TheCountersSeeAllocationsAndLocks) {
  const std::size_t allocations = allocations_here(), locks = locks_here;
  const std::vector<int> some(100, 1);
  std::mutex mutex;
  const std::lock_guard lock(mutex);
  EXPECT_EQ(some.front(), 1);
  EXPECT_GT(allocations_here(), allocations);
  EXPECT_GT(locks_here, locks);
}

TEST_F(WriterCost, PublishingAllocatesNothingAndTakesNoLock) {
  const std::size_t allocations = allocations_here(), locks = locks_here;
  publish_everything();
  const std::size_t allocated = allocations_here() - allocations, locked = locks_here - locks;
  EXPECT_EQ(allocated, 0U);
  EXPECT_EQ(locked, 0U);
  EXPECT_EQ(writer_->counted(Counter::lines_segment_full), 10U) << "what is refused was part of it";
}

}  // namespace
}  // namespace linescope::testing
