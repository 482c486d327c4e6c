// The daemon's loop for live devices with a camera whose pictures answer to its exposure.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>

#include "acquire/acquisition.hpp"
#include "acquire/camera/device_camera.hpp"
#include "ipc/control.hpp"
#include "ipc/segment_reader.hpp"

namespace linescope {
namespace {

using ::testing::HasSubstr;

constexpr int kWidth = 720, kHeight = 480;

/// A green line of `laser` grey levels per millisecond of exposure, as the camera's driver would give it.
class LitDevice final : public CaptureDevice {
 public:
  LitDevice(double laser, int pictures, std::atomic<bool>& stop)
      : laser_(laser), left_(pictures), stop_(stop) {}
  Result<OpenedDevice> open() override { return OpenedDevice{"lit device", kMillisecond, {}}; }
  void close() override {}
  Result<void> set_exposure(double milliseconds) override {
    exposure_ms_ = milliseconds;
    return {};
  }
  Result<void> set_gain(double) override { return {}; }
  double exposure_ms() const override { return exposure_ms_; }
  Result<Pull> read(cv::Mat& bgr, Nanoseconds& stamp) override {
    std::this_thread::sleep_for(std::chrono::milliseconds(3));
    if (left_-- <= 0) {
      stop_ = true;
      return Pull::nothing_yet;
    }
    bgr.create(kHeight, kWidth, CV_8UC3);
    bgr.setTo(cv::Scalar(2, 2, 2));
    for (int d = -12; d <= 12; ++d) {
      const double light = laser_ * exposure_ms_ * std::exp(-0.5 * d * d / 9.0);
      bgr.row(300 + d).setTo(cv::Scalar(0.15 * light, light, 0.15 * light));
    }
    stamp = monotonic_now() - 20 * kMillisecond;
    return Pull::item;
  }

 private:
  double laser_;
  double exposure_ms_ = 5;
  int left_;
  std::atomic<bool>& stop_;
};

class LiveLoop : public ::testing::Test {
 protected:
  static SegmentOptions segment_options() {
    SegmentOptions options;
    options.name = "linescope-unit-live-" + std::to_string(::getpid());
    options.line_capacity = 100;
    options.points_per_line = kWidth;
    options.point_capacity = 100 * kWidth;
    options.picture_bytes = kWidth * kHeight * 3;
    return options;
  }
  std::unique_ptr<Acquisition> with_laser(double laser, int pictures) {
    AcquireOptions options;
    options.tracker.source = "none";
    Sources sources;
    sources.camera = std::make_unique<DeviceCamera>(std::make_unique<LitDevice>(laser, pictures, stop_));
    sources.calibration = thesis_camera_ii();
    EXPECT_TRUE(sources.camera->start());
    return std::move(Acquisition::create(options, std::move(sources), writer_, stop_).value());
  }
  CameraReport shown() const {
    CameraReport report;
    SegmentReader::attach({.name = segment_options().name})->camera_status(report);
    return report;
  }
  std::uint64_t count(Counter which) const {
    for (const CounterValue& value : SegmentReader::attach({.name = segment_options().name})->counters())
      if (value.name == name(which)) return value.value;
    return 0;
  }

  SegmentWriter writer_ = SegmentWriter::create(segment_options()).value();
  std::atomic<bool> stop_{false};
};

TEST_F(LiveLoop, TheExposureIsSetForTheLineAndShown) {
  auto acquisition = with_laser(400, 200);
  run_live(*acquisition);
  acquisition->state.update(monotonic_now() + kSecond);
  EXPECT_LE(acquisition->laser.light().saturated, LineExposureOptions{}.max_saturated);
  EXPECT_LT(shown().exposure_ms, 1);
  EXPECT_GT(shown().exposure_ms, 0.1F);
  EXPECT_THAT(shown().reason, HasSubstr("line quality"));
}

TEST_F(LiveLoop, PicturesOlderThanTheirPeriodAreCounted) {
  auto acquisition = with_laser(40, 300);
  run_live(*acquisition);
  acquisition->state.update(monotonic_now() + kSecond);
  EXPECT_GT(count(Counter::frames_received), 0u);
  EXPECT_EQ(count(Counter::frames_late), count(Counter::frames_received))
      << "20 ms old, every millisecond one";
}

TEST_F(LiveLoop, AViewersExposureIsCarriedOutAndZeroGivesItBack) {
  auto acquisition = with_laser(40, 100'000);
  std::thread loop([&] { run_live(*acquisition); });
  auto reader = SegmentReader::attach({.name = segment_options().name}).value();
  auto client = ControlClient::open(reader);
  ASSERT_TRUE(client) << client.error().message;
  const auto ask = [&](double milliseconds) {
    const auto id = client->send({CommandKind::exposure, milliseconds, {}});
    const auto answer = client->await(id.value(), 20 * kSecond);
    return answer ? answer->kind : AnswerKind::lost;
  };
  const auto shows = [&](auto condition) {
    for (int i = 0; i < 4000 && !condition(shown()); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return condition(shown());
  };
  EXPECT_EQ(ask(17.5), AnswerKind::done);
  EXPECT_TRUE(shows([](const CameraReport& r) { return r.exposure_ms == 17.5F; }));
  EXPECT_TRUE(
      shows([](const CameraReport& r) { return r.reason.find("lower the laser") != std::string::npos; }));
  EXPECT_EQ(ask(-3), AnswerKind::refused);
  EXPECT_EQ(ask(0), AnswerKind::done);
  EXPECT_TRUE(shows([](const CameraReport& r) { return r.exposure_ms < 6; })) << shown().exposure_ms;
  stop_ = true;
  loop.join();
}

}  // namespace
}  // namespace linescope
