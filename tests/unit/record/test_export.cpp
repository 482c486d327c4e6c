// The exports, read back by somebody else's reader (VTK's MetaImage) and compared with the samples of PLUS.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "acquire/camera/picture_folder.hpp"
#include "acquire/record/recorder.hpp"
#include "acquire/tracker/timed_pose_source.hpp"
#include "tests/support/child_process.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/unit/record/sample_data.hpp"
#include "tools/export/export_recording.hpp"

namespace linescope {
namespace {

using ::testing::HasSubstr;
using testing::made_frame;
using testing::made_info;

using Header = std::map<std::string, std::string>;

/// "Name = value" lines up to the pixels.
Header header_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  Header header;
  for (std::string line; std::getline(stream, line);) {
    const auto equals = line.find(" = ");
    if (equals == std::string::npos) continue;
    std::string value = line.substr(equals + 3);
    value.erase(value.find_last_not_of(' ') + 1);
    header[line.substr(0, equals)] = value;
    if (line.rfind("ElementDataFile", 0) == 0) break;
  }
  return header;
}

Eigen::Matrix4d matrix_of(const std::string& text) {
  std::istringstream stream(text);
  Eigen::Matrix4d matrix;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) stream >> matrix(row, column);
  }
  EXPECT_TRUE(stream) << text;
  return matrix;
}

/// A sensor that moves 1 mm per 10 ms along x and turns 0.01 rad per 10 ms about z.
PoseSample moving(std::uint32_t count, int station) {
  PoseSample sample;
  sample.time = static_cast<Nanoseconds>(count) * 10 * kMillisecond;
  sample.arrival = sample.time + 3 * kMillisecond;
  sample.frame_count = count;
  sample.station = static_cast<std::uint8_t>(station);
  sample.state = station == 1 && count == 5 ? ToolState::out_of_view : ToolState::ok;
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.01 * count, Eigen::Vector3d::UnitZ()));
  sample.world_from_sensor = {turn, Eigen::Vector3d(count, 10.0 * station, 0)};
  return sample;
}

class ExportTest : public ::testing::Test {
 protected:
  /// 20 cycles of three stations; 4 pictures at 25, 65, 105, 145 ms (after the latency of 2 ms is off).
  void record() const {
    RecordingInfo info = made_info();
    info.calibration.camera_latency = 2 * kMillisecond;
    RecorderOptions options;
    options.folder = folder / "scan";
    options.keep_free = 0;
    auto recorder = Recorder::start(options, info);
    ASSERT_TRUE(recorder) << recorder.error().message;
    for (std::uint32_t count = 0; count < 20; ++count) {
      for (int station = 0; station < 3; ++station) (*recorder)->add(moving(count, station));
    }
    for (std::uint64_t i = 0; i < 4; ++i) {
      Frame frame = made_frame(i, 6, 4);
      frame.time = static_cast<Nanoseconds>(27 + 40 * i) * kMillisecond;
      (*recorder)->add(frame);
    }
    (*recorder)->add_event(5 * kMillisecond, "scan started");
    (*recorder)->stop();
  }
  testing::TemporaryFolder folder;
};

TEST_F(ExportTest, PicturesCarryThePosesOfTheirInstant) {
  record();
  const auto report = export_pictures_sequence(folder / "scan", folder / "out.igs.mha");
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->written, 4U);
  Header header = header_of(folder / "out.igs.mha");
  EXPECT_EQ(header["DimSize"], "6 4 4");
  EXPECT_EQ(header["ElementNumberOfChannels"], "3");
  EXPECT_EQ(header["Seq_Frame0001_Timestamp"], "0.065000000");
  EXPECT_EQ(header["Seq_Frame0001_UnfilteredTimestamp"], "0.067000000");
  EXPECT_EQ(header["Seq_Frame0001_FrameNumber"], "1");
  EXPECT_EQ(header["Seq_Frame0001_ImageStatus"], "OK");
  EXPECT_EQ(header["Seq_Frame0001_HarvesterToWorldTransformStatus"], "OK");
  // 65 ms is 6.5 cycles: 6.5 mm along x and 0.065 rad about z, for a motion that is uniform in both.
  const Eigen::Matrix4d pose = matrix_of(header["Seq_Frame0001_HarvesterToWorldTransform"]);
  EXPECT_NEAR(pose(0, 3), 6.5, 1e-9);
  EXPECT_NEAR(pose(1, 3), 20, 1e-9);
  EXPECT_NEAR(std::atan2(pose(1, 0), pose(0, 0)), 0.065, 1e-9);
  EXPECT_EQ(pose.row(3), Eigen::RowVector4d(0, 0, 0, 1));
}

TEST_F(ExportTest, TipAndCameraFollowTheirSensors) {
  record();
  ASSERT_TRUE(export_pictures_sequence(folder / "scan", folder / "out.igs.mha"));
  Header header = header_of(folder / "out.igs.mha");
  const Calibration c = made_info().calibration;
  const Eigen::Matrix4d harvester = matrix_of(header["Seq_Frame0002_HarvesterToWorldTransform"]);
  const Eigen::Matrix4d tip = matrix_of(header["Seq_Frame0002_HarvesterTipToWorldTransform"]);
  EXPECT_TRUE(tip.col(3).isApprox(harvester * c.harvester.tip.homogeneous(), 1e-12));
  const Eigen::Vector3d axis = harvester.topLeftCorner<3, 3>() * c.harvester.axis;
  EXPECT_TRUE((tip.topLeftCorner<3, 1>().cross(tip.block<3, 1>(0, 1)).isApprox(axis, 1e-9)))
      << "z of the tip frame";
  const Eigen::Matrix4d endoscope = matrix_of(header["Seq_Frame0002_EndoscopeToWorldTransform"]);
  const Eigen::Matrix4d camera = matrix_of(header["Seq_Frame0002_CameraToWorldTransform"]);
  EXPECT_TRUE(camera.isApprox(endoscope * c.endoscope_from_camera.isometry().matrix(), 1e-12));
}

TEST_F(ExportTest, PoseNextToABadSampleIsInvalidNotGuessed) {
  record();  // the knee's sensor is out of view at 50 ms
  RecordingInfo info = made_info();
  ASSERT_TRUE(export_tracker_sequence(folder / "scan", folder / "cycles.igs.mha"));
  Header header = header_of(folder / "cycles.igs.mha");
  EXPECT_EQ(header["DimSize"], "1 1 20");
  EXPECT_EQ(header["Seq_Frame0005_ObjectToWorldTransformStatus"], "INVALID");
  EXPECT_EQ(matrix_of(header["Seq_Frame0005_ObjectToWorldTransform"]), Eigen::Matrix4d::Identity());
  EXPECT_EQ(header["Seq_Frame0005_EndoscopeToWorldTransformStatus"], "OK");
  EXPECT_EQ(header["Seq_Frame0006_ObjectToWorldTransformStatus"], "OK");
  EXPECT_EQ(header["Seq_Frame0005_ImageStatus"], "INVALID");
  EXPECT_EQ(header["Seq_Frame0007_Timestamp"], "0.070000000");
  EXPECT_EQ(header["Seq_Frame0007_UnfilteredTimestamp"], "0.073000000") << "as it arrived";
}

TEST_F(ExportTest, PixelsAreRedGreenBlueRowByRow) {
  record();
  ASSERT_TRUE(export_pictures_sequence(folder / "scan", folder / "out.igs.mha"));
  std::ifstream stream(folder / "out.igs.mha", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  const std::string marker = "ElementDataFile = LOCAL\n";
  const std::string pixels = bytes.substr(bytes.find(marker) + marker.size());
  ASSERT_EQ(pixels.size(), 6U * 4 * 3 * 4);
  const Frame frame = made_frame(2, 6, 4);
  const std::size_t start = 2 * 6 * 4 * 3 + (1 * 6 + 5) * 3;
  const cv::Vec3b expected = frame.bgr.at<cv::Vec3b>(1, 5);
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_EQ(static_cast<unsigned char>(pixels[start + static_cast<std::size_t>(channel)]),
              expected[2 - channel]);
  }
}

TEST_F(ExportTest, PicturesOfAnotherSizeAreLeftOutAndCounted) {
  RecorderOptions options;
  options.folder = folder / "scan";
  options.keep_free = 0;
  auto recorder = Recorder::start(options, made_info());
  for (const int width : {6, 8, 6}) (*recorder)->add(made_frame(static_cast<std::uint64_t>(width), width, 4));
  (*recorder)->stop();
  const auto report = export_pictures_sequence(folder / "scan", folder / "out.igs.mha");
  ASSERT_TRUE(report);
  EXPECT_EQ(report->written, 2U);
  EXPECT_EQ(report->other_size, 1U);
  EXPECT_EQ(report->without_pose, 2U) << "there are no samples at all";
  EXPECT_EQ(header_of(folder / "out.igs.mha")["DimSize"], "6 4 2");
}

TEST_F(ExportTest, PoseListIsReadByTheRecordedTracker) {
  record();
  const auto report = export_poses_csv(folder / "scan", folder / "poses.csv");
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->written, 60U);
  TimedPoseSource source(folder / "poses.csv", {});
  ASSERT_TRUE(source.start());
  PoseSample sample;
  for (std::uint32_t i = 0; i < 60; ++i) {
    const auto pull = source.next(sample);
    ASSERT_TRUE(pull) << pull.error().message;
    ASSERT_EQ(*pull, Pull::item);
    const PoseSample expected = moving(i / 3, static_cast<int>(i % 3));
    EXPECT_EQ(sample.time, expected.time);
    EXPECT_EQ(sample.arrival, expected.arrival);
    EXPECT_EQ(sample.station, expected.station);
    EXPECT_EQ(sample.state, expected.state);
    EXPECT_EQ(sample.frame_count, expected.frame_count);
  }
}

TEST_F(ExportTest, PicturesAsFilesAreTheSamePixels) {
  record();
  ASSERT_TRUE(export_pictures(folder / "scan", folder / "png"));
  PictureFolder source({.folder = folder / "png"});
  ASSERT_TRUE(source.start());
  Frame frame;
  for (std::uint64_t i = 0; i < 4; ++i) {
    ASSERT_EQ(source.next(frame).value(), Pull::item);
    EXPECT_EQ(cv::norm(frame.bgr, made_frame(i, 6, 4).bgr, cv::NORM_INF), 0);
  }
  std::ifstream list(folder / "png" / "pictures.csv");
  std::string line;
  std::getline(list, line);
  EXPECT_EQ(line, "frame,number,time_s,source_name");
  std::getline(list, line);
  std::getline(list, line);
  EXPECT_EQ(line, "000001.png,1,0.067000000,im1.png");
}

TEST_F(ExportTest, EventsAreLines) {
  record();
  ASSERT_TRUE(export_events(folder / "scan", folder / "events.txt"));
  std::ifstream stream(folder / "events.txt");
  std::string line;
  std::getline(stream, line);
  EXPECT_EQ(line, "0.005000000 scan started");
}

TEST_F(ExportTest, FailuresAreSentences) {
  EXPECT_EQ(export_tracker_sequence(folder / "none", folder / "a").error().code, ErrorCode::not_found);
  record();
  EXPECT_THAT(export_tracker_sequence(folder / "scan", folder / "no" / "such" / "a.mha").error().message,
              HasSubstr("cannot be written"));
  std::filesystem::resize_file(folder / "scan" / kPictureFile, 0);
  EXPECT_THAT(export_pictures_sequence(folder / "scan", folder / "a.mha").error().message,
              HasSubstr("holds no picture; --tracker exports the poses alone"));
  EXPECT_THAT(export_tracker_sequence(folder / "scan", "/dev/full").error().message,
              HasSubstr("is the disk full?"));
}

}  // namespace
}  // namespace linescope
