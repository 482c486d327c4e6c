// The live source over a scripted camera: nothing here depends on how fast the machine is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <deque>

#include "acquire/camera/device_camera.hpp"

namespace linescope {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

/// What the camera does, step by step; shared with the test, which outlives the source.
struct Script {
  enum class Step { picture, broken, silence, unplug };
  std::mutex mutex;
  std::deque<Step> steps;  ///< empty: silence
  int refuse_open = 0;     ///< so many further calls of open() fail
  int opened = 0;
  int read = 0;
  cv::Size size{3, 2};
  Nanoseconds stamp_offset = 0;  ///< stamp = now - offset; negative: the driver gives none
  Nanoseconds now = 1000 * kSecond;
  std::vector<double> exposures;

  void add(Step step, int count = 1) {
    const std::lock_guard lock(mutex);
    steps.insert(steps.end(), static_cast<std::size_t>(count), step);
  }
};

class ScriptedDevice final : public CaptureDevice {
 public:
  explicit ScriptedDevice(Script& script) : script_(script) {}

  Result<OpenedDevice> open() override {
    const std::lock_guard lock(script_.mutex);
    if (script_.refuse_open > 0) {
      --script_.refuse_open;
      return fail(ErrorCode::not_found, "no camera is connected; plug one in");
    }
    ++script_.opened;
    return OpenedDevice{"scripted camera", 40 * kMillisecond, {"60 Hz were asked, the camera gives 25 Hz"}};
  }
  void close() override {}
  Result<Pull> read(cv::Mat& bgr, Nanoseconds& stamp) override {
    const std::lock_guard lock(script_.mutex);
    if (script_.steps.empty()) return silence();
    const Script::Step step = script_.steps.front();
    script_.steps.pop_front();
    if (step == Script::Step::broken) return fail(ErrorCode::unreadable, "broken");
    if (step == Script::Step::unplug) return fail(ErrorCode::gone, "the camera was unplugged");
    if (step == Script::Step::silence) return silence();
    bgr.create(script_.size, CV_8UC3);
    bgr.setTo(cv::Scalar::all(++script_.read));
    stamp = script_.stamp_offset < 0 ? 0 : script_.now - script_.stamp_offset;
    return Pull::item;
  }
  Result<void> set_exposure(double milliseconds) override {
    const std::lock_guard lock(script_.mutex);
    script_.exposures.push_back(milliseconds);
    if (milliseconds > 100)
      return fail(ErrorCode::invalid, "exposure (ms) 200 was asked, the camera has 100");
    return {};
  }
  Result<void> set_gain(double) override {
    return fail(ErrorCode::unsupported, "the camera has no control for gain");
  }

 private:
  static Result<Pull> silence() {
    std::this_thread::yield();
    return Pull::nothing_yet;
  }
  Script& script_;
};

class LiveCamera : public ::testing::Test {
 protected:
  using Step = Script::Step;

  DeviceCameraTiming timing() {
    DeviceCameraTiming result;
    result.longest_wait = kMillisecond;
    result.reconnect_every = kMillisecond;
    result.now = [this] {
      const std::lock_guard lock(script.mutex);
      return script.now;
    };
    return result;
  }
  /// Asks until a picture comes; the test's own time limit ends it otherwise.
  void wait_for_picture(CameraSource& source) {
    for (;;) {
      const auto pull = source.next(frame);
      ASSERT_TRUE(pull) << pull.error().message;
      if (*pull == Pull::item) return;
    }
  }
  template <class Condition>
  CameraStatus wait_for(CameraSource& source, Condition condition) {
    CameraStatus status = source.status();
    while (!condition(status)) {
      std::this_thread::yield();
      status = source.status();
    }
    return status;
  }
  void advance(Nanoseconds time) {
    const std::lock_guard lock(script.mutex);
    script.now += time;
  }

  Script script;
  Frame frame;
};

TEST_F(LiveCamera, AbsenceIsToldByStartAndCanBeTriedAgain) {
  script.refuse_open = 1;
  DeviceCamera source(std::make_unique<ScriptedDevice>(script), timing());
  EXPECT_EQ(source.start().error().code, ErrorCode::not_found);
  EXPECT_EQ(source.status().state, CameraState::not_started);
  EXPECT_TRUE(source.start());
}

TEST_F(LiveCamera, SaysNothingYetInsteadOfWaiting) {
  DeviceCamera source(std::make_unique<ScriptedDevice>(script), timing());
  ASSERT_TRUE(source.start());
  EXPECT_EQ(source.next(frame).value(), Pull::nothing_yet);
  EXPECT_EQ(source.status().state, CameraState::waiting);
  EXPECT_TRUE(source.live());
}

TEST_F(LiveCamera, PicturesCarryTheDriversStamp) {
  script.stamp_offset = 15 * kMillisecond;
  script.add(Step::picture);
  DeviceCamera source(std::make_unique<ScriptedDevice>(script), timing());
  ASSERT_TRUE(source.start());
  wait_for_picture(source);
  EXPECT_EQ(frame.time, 1000 * kSecond - 15 * kMillisecond);
  EXPECT_EQ(frame.index, 0U);
  EXPECT_EQ(source.status().state, CameraState::ok);
  EXPECT_EQ(source.status().counters.late, 0U);
}

struct OddStamp {
  const char* name;
  Nanoseconds offset;
};
class LiveCameraOddStamp : public LiveCamera, public ::testing::WithParamInterface<OddStamp> {};

TEST_P(LiveCameraOddStamp, ArrivalCountsInstead) {
  script.stamp_offset = GetParam().offset;
  script.add(Step::picture);
  DeviceCamera source(std::make_unique<ScriptedDevice>(script), timing());
  ASSERT_TRUE(source.start());
  wait_for_picture(source);
  EXPECT_EQ(frame.time, 1000 * kSecond);
}
INSTANTIATE_TEST_SUITE_P(Stamps, LiveCameraOddStamp,
                         ::testing::Values(OddStamp{"None", -1}, OddStamp{"OtherClock", 900 * kSecond}),
                         [](const auto& test) { return test.param.name; });

TEST_F(LiveCamera, PictureOlderThanItsPeriodIsCounted) {
  script.stamp_offset = 41 * kMillisecond;
  script.add(Step::picture);
  DeviceCamera source(std::make_unique<ScriptedDevice>(script), timing());
  ASSERT_TRUE(source.start());
  wait_for_picture(source);
  EXPECT_EQ(source.status().counters.late, 1U);
}

TEST_F(LiveCamera, BrokenPictureIsCountedAndSeenInTheIndex) {
  script.add(Step::broken);
  script.add(Step::picture);
  DeviceCamera source(std::make_unique<ScriptedDevice>(script), timing());
  ASSERT_TRUE(source.start());
  wait_for_picture(source);
  EXPECT_EQ(frame.index, 1U);
  EXPECT_EQ(source.status().counters.unreadable, 1U);
}

TEST_F(LiveCamera, UnfetchedPicturesAreDroppedOldestFirstAndCounted) {
  script.add(Step::picture, 10);
  DeviceCamera source(std::make_unique<ScriptedDevice>(script), timing());
  ASSERT_TRUE(source.start());
  wait_for(source, [](const CameraStatus& s) { return s.counters.overrun == 6; });
  for (std::uint64_t i = 6; i < 10; ++i) {
    wait_for_picture(source);
    EXPECT_EQ(frame.index, i);
    EXPECT_EQ(frame.bgr.at<cv::Vec3b>(0, 0)[0], i + 1) << "pixels belong to the index";
  }
  EXPECT_EQ(source.status().counters.delivered, 4U);
}

TEST_F(LiveCamera, UnpluggedCameraIsFoundAgain) {
  script.add(Step::picture);
  DeviceCamera source(std::make_unique<ScriptedDevice>(script), timing());
  ASSERT_TRUE(source.start());
  wait_for_picture(source);
  {
    const std::lock_guard lock(script.mutex);
    script.refuse_open = 3;
  }
  script.add(Step::unplug);
  const auto lost =
      wait_for(source, [](const CameraStatus& s) { return s.state == CameraState::disconnected; });
  EXPECT_EQ(lost.counters.disconnected, 1U);
  EXPECT_THAT(lost.reason, ::testing::AnyOf(HasSubstr("unplugged"), HasSubstr("plug one in")));
  wait_for(source, [](const CameraStatus& s) { return s.state == CameraState::waiting; });
  script.add(Step::picture);
  wait_for_picture(source);
  EXPECT_EQ(source.status().state, CameraState::ok);
  EXPECT_EQ(script.opened, 2);
}

TEST_F(LiveCamera, SilentCameraIsOpenedAnew) {
  DeviceCamera source(std::make_unique<ScriptedDevice>(script), timing());
  ASSERT_TRUE(source.start());
  advance(3 * kSecond);
  const auto status = wait_for(source, [](const CameraStatus& s) { return s.counters.disconnected == 1; });
  wait_for(source, [](const CameraStatus& s) { return s.state == CameraState::waiting; });
  EXPECT_EQ(script.opened, 2);
}

TEST_F(LiveCamera, RefusedSettingsAreSaid) {
  DeviceCamera source(std::make_unique<ScriptedDevice>(script), timing());
  ASSERT_TRUE(source.start());
  EXPECT_THAT(source.status().remarks, Contains("60 Hz were asked, the camera gives 25 Hz"));
  ASSERT_TRUE(source.set_exposure(200));
  ASSERT_TRUE(source.set_gain(5));
  const auto both = [](const CameraStatus& s) { return s.remarks.size() == 3; };
  const auto status = wait_for(source, both);
  EXPECT_THAT(status.remarks, Contains("exposure (ms) 200 was asked, the camera has 100"));
  EXPECT_THAT(status.remarks, Contains("the camera has no control for gain"));
  ASSERT_TRUE(source.set_exposure(5));
  wait_for(source, [](const CameraStatus& s) { return s.remarks.size() == 2; });
  EXPECT_THAT(script.exposures, ::testing::ElementsAre(200, 5));
}

TEST_F(LiveCamera, ImpossibleSettingsAreRefusedAtOnce) {
  DeviceCamera source(std::make_unique<ScriptedDevice>(script), timing());
  EXPECT_EQ(source.set_exposure(0).error().code, ErrorCode::invalid);
  EXPECT_EQ(source.set_exposure(1e9).error().code, ErrorCode::invalid);
  EXPECT_EQ(source.set_gain(-1).error().code, ErrorCode::invalid);
  EXPECT_EQ(source.next(frame).error().code, ErrorCode::usage);
}

TEST_F(LiveCamera, PictureMemoryIsHandedRound) {
  DeviceCamera source(std::make_unique<ScriptedDevice>(script), timing());
  ASSERT_TRUE(source.start());
  std::vector<const void*> seen;
  for (int i = 0; i < 50; ++i) {
    script.add(Step::picture);
    wait_for_picture(source);
    if (std::find(seen.begin(), seen.end(), frame.bgr.data) == seen.end()) seen.push_back(frame.bgr.data);
  }
  EXPECT_LE(seen.size(), DeviceCamera::kQueue + 2)
      << "one picture in the thread, one at the caller, the rest in the queue";
}

TEST_F(LiveCamera, PicturesOfACameraLieOnLargePages) {
  constexpr std::uintptr_t kPage = 2 << 20;
  script.size = {640, 480};
  DeviceCamera source(std::make_unique<ScriptedDevice>(script), timing());
  ASSERT_TRUE(source.start());
  for (std::size_t i = 0; i < 3 * DeviceCamera::kQueue; ++i) {
    script.add(Step::picture);
    wait_for_picture(source);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(frame.bgr.data) % kPage, 0U) << "picture " << i;
  }
}

}  // namespace
}  // namespace linescope
