#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <fstream>

#include "acquire/camera/camera_choice.hpp"
#include "acquire/camera/camera_list.hpp"
#include "tests/support/child_process.hpp"

namespace linescope {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

const CameraInfo kWebcam{"/dev/video0", "Integrated Webcam", ""};
const CameraInfo kMetadata{"/dev/video1", "Integrated Webcam", "/dev/video1 gives no pictures"};
const CameraInfo kEndoscope{"/dev/video2", "USB2.0 Endoscope", ""};
const CameraInfo kBusy{"/dev/video4", "Grabber", obstacle_from_errno("/dev/video4", EBUSY)};
const CameraInfo kForbidden{"/dev/video6", "Locked", obstacle_from_errno("/dev/video6", EACCES)};
const std::vector<CameraInfo> kAll{kWebcam, kMetadata, kEndoscope, kBusy, kForbidden};

TEST(ChooseCamera, ByPathIndexNameOrTheFirstUsable) {
  EXPECT_EQ(choose_camera("/dev/video2", kAll)->name, "USB2.0 Endoscope");
  EXPECT_EQ(choose_camera("2", kAll)->name, "USB2.0 Endoscope");
  EXPECT_EQ(choose_camera("Endoscope", kAll)->path, "/dev/video2");
  EXPECT_EQ(choose_camera("", kAll)->path, "/dev/video0");
  EXPECT_EQ(choose_camera("", {kMetadata, kEndoscope})->path, "/dev/video2")
      << "metadata nodes are passed over";
}

TEST(ChooseCamera, ObstacleOfTheMeantCameraIsTheAnswer) {
  EXPECT_EQ(choose_camera("4", kAll).error().code, ErrorCode::busy);
  EXPECT_THAT(choose_camera("4", kAll).error().message, HasSubstr("in use by another program"));
  EXPECT_EQ(choose_camera("Locked", kAll).error().code, ErrorCode::permission);
  EXPECT_EQ(choose_camera("1", kAll).error().code, ErrorCode::unsupported);
}

TEST(ChooseCamera, NoCameraAndUnknownCameraSayWhatThereIs) {
  EXPECT_EQ(choose_camera("", {}).error().message,
            "no camera is connected; plug one in, or name a folder of pictures or a video file");
  EXPECT_EQ(
      choose_camera("9", {kWebcam, kBusy}).error().message,
      "there is no camera 9; there is /dev/video0 (Integrated Webcam), /dev/video4 (Grabber, not usable)");
}

TEST(ListCameras, NodesThatAreNoCamerasAreListedWithTheReason) {
  const testing::TemporaryFolder root;
  for (const char* node : {"video10", "video2", "v4l-subdev0"}) {
    std::filesystem::create_directories(root / "sys" / node);
    std::ofstream(root / "sys" / node / "name") << "Name of " << node << '\n';
  }
  std::filesystem::create_directories(root / "dev");
  std::ofstream(root / "dev" / "video2") << "a plain file";
  const auto cameras = list_cameras(root / "sys", root / "dev");
  ASSERT_THAT(cameras, SizeIs(2));
  EXPECT_EQ(cameras[0].name, "Name of video2");
  EXPECT_THAT(cameras[0].obstacle, HasSubstr("is not a camera"));
  EXPECT_EQ(cameras[1].name, "Name of video10");
  EXPECT_THAT(cameras[1].obstacle, HasSubstr("was unplugged"));
}

TEST(ListCameras, MachineWithoutVideoIsAnEmptyList) {
  EXPECT_THAT(list_cameras("/nowhere", "/dev"), SizeIs(0));
}

TEST(CameraKindOf, FoldersFilesAndDevices) {
  const testing::TemporaryFolder root;
  std::ofstream(root / "scan.mkv") << "x";
  std::ofstream(root / "im0.png") << "x";
  EXPECT_EQ(kind_of_camera(root.path()), CameraKind::folder);
  EXPECT_EQ(kind_of_camera(root / "scan.mkv"), CameraKind::video);
  EXPECT_THAT(kind_of_camera(root / "im0.png").error().message, HasSubstr("is a single picture"));
  EXPECT_EQ(kind_of_camera(""), CameraKind::device);
  EXPECT_EQ(kind_of_camera("0"), CameraKind::device);
  EXPECT_EQ(kind_of_camera("/dev/video7"), CameraKind::device);
  EXPECT_EQ(kind_of_camera("USB2.0 Endoscope"), CameraKind::device);
  EXPECT_EQ(kind_of_camera("gone.mkv").error().code, ErrorCode::not_found);
  EXPECT_EQ(kind_of_camera("gone/").error().code, ErrorCode::not_found);
}

TEST(MakeCamera, ChecksTheOptionsOfTheKind) {
  const testing::TemporaryFolder root;
  EXPECT_FALSE((*make_camera({.source = root.path()}))->live());
  EXPECT_TRUE((*make_camera({.source = "0"}))->live());
  EXPECT_EQ(make_camera({.source = root.path(), .width = 640}).error().code, ErrorCode::invalid);
  CameraOptions options;
  options.device.pixel_format = "MJPEG";
  EXPECT_THAT(make_camera(options).error().message, HasSubstr("must have four characters"));
}

struct BadOption {
  const char* name;
  V4l2Options options;
};
class V4l2BadOption : public ::testing::TestWithParam<BadOption> {};
TEST_P(V4l2BadOption, IsRefused) {
  EXPECT_EQ(validate(GetParam().options).error().code, ErrorCode::invalid);
}
INSTANTIATE_TEST_SUITE_P(Each, V4l2BadOption,
                         ::testing::Values(BadOption{"Width", {.width = 0}},
                                           BadOption{"Height", {.height = 100'000}},
                                           BadOption{"Rate", {.rate_hz = 0}},
                                           BadOption{"Exposure", {.exposure_ms = -1}},
                                           BadOption{"WhiteBalance", {.white_balance_k = 5}}),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace linescope
