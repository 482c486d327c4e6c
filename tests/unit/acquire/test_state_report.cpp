// What the daemon says of its camera, read back as any viewer reads it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "acquire/state_report.hpp"
#include "ipc/segment_reader.hpp"

namespace linescope {
namespace {

using ::testing::HasSubstr;

class ToldCamera final : public CameraSource {
 public:
  Result<void> start() override { return {}; }
  Result<Pull> next(Frame&) override { return Pull::nothing_yet; }
  bool live() const override { return true; }
  std::string description() const override { return "told camera"; }
  CameraStatus status() const override { return told; }
  Result<void> set_exposure(double) override { return {}; }
  CameraStatus told;
};

class StateReportTest : public ::testing::Test {
 protected:
  StateReportTest() { report_.watch(&laser_); }

  static SegmentOptions small_segment() {
    SegmentOptions options;
    options.name = "linescope-unit-state-" + std::to_string(::getpid());
    options.point_capacity = 1000;
    options.line_capacity = 100;
    return options;
  }
  CameraReport shown() {
    report_.update(monotonic_now() + ++updates_ * kSecond);
    auto reader = SegmentReader::attach({.name = small_segment().name});
    CameraReport camera;
    if (reader) reader->camera_status(camera);
    return camera;
  }
  std::uint64_t count(Counter which) {
    auto reader = SegmentReader::attach({.name = small_segment().name});
    for (const CounterValue& value : reader->counters())
      if (value.name == name(which)) return value.value;
    return 0;
  }
  /// A line of so many saturated samples, as extracted.
  void look(float saturated) {
    ExtractedLine line;
    line.width = 100;
    line.height = 50;
    line.samples.resize(90);
    for (LineSample& sample : line.samples) sample.peak = 250;
    line.saturated_fraction = saturated;
    for (int i = 0; i < 200; ++i) laser_.look(line);
  }

  SegmentWriter writer_ = SegmentWriter::create(small_segment()).value();
  ToldCamera camera_;
  LaserWatch laser_{LineExposureOptions{}, 5, camera_};
  StateReport report_{camera_, nullptr, writer_};
  int updates_ = 0;
};

TEST_F(StateReportTest, TheLightOfTheLineAndTheHintReachTheSegment) {
  camera_.told.state = CameraState::ok;
  camera_.told.exposure_ms = 4.2;
  look(1);
  const CameraReport burnt = shown();
  EXPECT_EQ(burnt.state, ToolState::ok);
  EXPECT_FLOAT_EQ(burnt.exposure_ms, 4.2F);
  EXPECT_THAT(burnt.reason, HasSubstr("100 % burnt out; lower the laser"));
  EXPECT_THAT(burnt.reason, HasSubstr("line quality 0.00"));
}

TEST_F(StateReportTest, ACameraThatIsGoneSaysWhyInstead) {
  camera_.told.state = CameraState::disconnected;
  camera_.told.reason = "camera /dev/video0 (Endoscope) was unplugged";
  look(1);
  const CameraReport gone = shown();
  EXPECT_EQ(gone.state, ToolState::disconnected);
  EXPECT_EQ(gone.reason, "camera /dev/video0 (Endoscope) was unplugged");
}

TEST_F(StateReportTest, LatePicturesAndEveryOtherLossAreCounted) {
  camera_.told.state = CameraState::ok;
  shown();
  camera_.told.counters.late = 3;
  camera_.told.counters.overrun = 2;
  camera_.told.counters.disconnected = 1;
  shown();
  camera_.told.counters.late = 5;
  shown();
  EXPECT_EQ(count(Counter::frames_late), 5u);
  EXPECT_EQ(count(Counter::frames_overrun), 2u);
  EXPECT_EQ(count(Counter::camera_reconnects), 1u);
}

TEST_F(StateReportTest, AnUnusablePictureIsSaidForAWhile) {
  camera_.told.state = CameraState::ok;
  report_.note({ErrorCode::unreadable, "im7.png is broken"});
  EXPECT_EQ(shown().reason, "im7.png is broken");
  updates_ += 10;
  EXPECT_EQ(shown().reason, "");
}

}  // namespace
}  // namespace linescope
