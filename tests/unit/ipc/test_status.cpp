// State, status, texts, counters, latencies.
#include "tests/unit/ipc/segment_fixture.hpp"

namespace linescope::testing {
namespace {

using Status = SegmentTest;

TEST_F(Status, ANewSegmentIsStarting) {
  DaemonStatus status;
  ASSERT_EQ(reader_->status(status), ReadOutcome::ok);
  EXPECT_EQ(status.state, DaemonState::starting);
}

TEST_F(Status, StateCarriesItsReason) {
  writer_->set_state(DaemonState::camera_lost, "the camera was unplugged");
  DaemonStatus status;
  ASSERT_EQ(reader_->status(status), ReadOutcome::ok);
  EXPECT_EQ(status.state, DaemonState::camera_lost);
  EXPECT_EQ(status.reason, "the camera was unplugged");
  EXPECT_GT(status.since, 0);
}

TEST_F(Status, ALongReasonIsCutBetweenCharacters) {
  const std::string long_reason =
      std::string(230, 'x') + "\xc3\xa4\xc3\xa4";  // two bytes each: the first one does not fit
  writer_->set_state(DaemonState::idle, long_reason);
  DaemonStatus status;
  reader_->status(status);
  EXPECT_EQ(status.reason, std::string(230, 'x'));
}

TEST_F(Status, SensorsKeepRoleStateAndFigures) {
  SensorStatus in;
  in.role = SensorRole::harvester;
  in.state = ToolState::out_of_view;
  in.time = 7;
  in.last_good = 5;
  in.samples = 1000;
  in.lost = 3;
  in.nominal_hz = 240;
  in.name = "harvester";
  in.reason = "1.8 m from the transmitter";
  writer_->set_sensor_status(2, in);
  SensorStatus out;
  ASSERT_EQ(reader_->sensor_status(2, out), ReadOutcome::ok);
  EXPECT_EQ(out.role, in.role);
  EXPECT_EQ(out.state, in.state);
  EXPECT_EQ(out.time, in.time);
  EXPECT_EQ(out.last_good, in.last_good);
  EXPECT_EQ(out.samples, in.samples);
  EXPECT_EQ(out.lost, in.lost);
  EXPECT_EQ(out.nominal_hz, in.nominal_hz);
  EXPECT_EQ(out.name, in.name);
  EXPECT_EQ(out.reason, in.reason);
  EXPECT_EQ(reader_->sensor_status(3, out), ReadOutcome::nothing);
  EXPECT_EQ(reader_->sensor_status(8, out), ReadOutcome::nothing);
}

TEST_F(Status, TheCameraKeepsStateAndFigures) {
  CameraReport in;
  in.state = ToolState::disconnected;
  in.time = 11;
  in.last_good = 10;
  in.frames = 99;
  in.width = 640;
  in.height = 480;
  in.nominal_hz = 30;
  in.exposure_ms = 2.5F;
  in.name = "USB camera";
  in.reason = "unplugged";
  writer_->set_camera_status(in);
  CameraReport out;
  ASSERT_EQ(reader_->camera_status(out), ReadOutcome::ok);
  EXPECT_EQ(out.state, in.state);
  EXPECT_EQ(out.time, in.time);
  EXPECT_EQ(out.last_good, in.last_good);
  EXPECT_EQ(out.frames, in.frames);
  EXPECT_EQ(out.width, in.width);
  EXPECT_EQ(out.height, in.height);
  EXPECT_EQ(out.nominal_hz, in.nominal_hz);
  EXPECT_EQ(out.exposure_ms, in.exposure_ms);
  EXPECT_EQ(out.name, in.name);
  EXPECT_EQ(out.reason, in.reason);
}

TEST_F(Status, TextsOfEveryLengthComeBackAndCanBeReplaced) {
  std::string out;
  EXPECT_EQ(reader_->configuration(out), ReadOutcome::nothing);
  for (std::size_t length : {0U, 1U, 7U, 8U, 9U, 255U, 256U}) {
    const std::string text(length, 'a');
    ASSERT_TRUE(writer_->publish_configuration(text));
    ASSERT_EQ(reader_->configuration(out), ReadOutcome::ok);
    EXPECT_EQ(out, text);
  }
  writer_->publish_calibration("yaml");
  ASSERT_EQ(reader_->calibration(out), ReadOutcome::ok);
  EXPECT_EQ(out, "yaml");
}

TEST_F(Status, ATextThatIsTooLongIsCountedAndTheFormerStays) {
  writer_->publish_configuration("short");
  EXPECT_FALSE(writer_->publish_configuration(std::string(257, 'x')));
  EXPECT_EQ(writer_->counted(Counter::texts_too_long), 1U);
  std::string out;
  reader_->configuration(out);
  EXPECT_EQ(out, "short");
}

TEST_F(Status, CountersCarryTheirNames) {
  writer_->count(Counter::frames_unreadable, 5);
  const std::vector<CounterValue> counters = reader_->counters();
  ASSERT_EQ(counters.size(), static_cast<std::size_t>(LS_COUNTER_COUNT));
  const auto& c = counters[LS_COUNT_frames_unreadable];
  EXPECT_EQ(c.name, "frames_unreadable");
  EXPECT_EQ(c.value, 5U);
}

TEST_F(Status, LatenciesGivePercentiles) {
  for (int i = 1; i <= 1000; ++i) writer_->record_latency(LatencyStage::extract, i * kMicrosecond);
  const LatencyFigures f = reader_->latencies()[LS_LATENCY_extract];
  EXPECT_EQ(f.name, "extract");
  EXPECT_EQ(f.count, 1000U);
  EXPECT_EQ(f.max, kMillisecond);
  EXPECT_EQ(f.last, kMillisecond);
  EXPECT_EQ(f.mean, 500'500);
  EXPECT_GE(f.p50, 500 * kMicrosecond);
  EXPECT_LE(f.p50, 625 * kMicrosecond);
  EXPECT_GE(f.p99, 990 * kMicrosecond);
  EXPECT_LE(f.p99, f.max);
}

}  // namespace
}  // namespace linescope::testing
