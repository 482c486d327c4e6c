#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <opencv2/aruco/charuco.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "common/camera_file.hpp"
#include "tools/calibrate/inputs.hpp"
#include "tools/calibrate/record_entry.hpp"

namespace linescope::calibrate {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class Folder : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::path(::testing::TempDir()) / ::testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  fs::path folder_;
};

using SessionInput = Folder;
using CalibrationEntries = Folder;
using CameraFiles = Folder;

/// Squares of 40 px, corner (0, 0) at (60 + 40, 50 + 40), drawn without the code under test.
cv::Mat drawn_chessboard(int columns, int rows) {
  cv::Mat m(480, 640, CV_8UC1, cv::Scalar(230));
  for (int y = 0; y <= rows; ++y)
    for (int x = 0; x <= columns; ++x)
      if ((x + y) % 2 == 0) cv::rectangle(m, {60 + 40 * x, 50 + 40 * y, 40, 40}, cv::Scalar(20), cv::FILLED);
  cv::GaussianBlur(m, m, {}, 1.0);
  return m;
}

TEST(BoardFinder, NumbersTheSameCornerAlikeHoweverTheBoardIsTurned) {
  const BoardOptions board{.kind = BoardKind::chessboard, .corners_x = 9, .corners_y = 6, .square_mm = 1};
  const BoardFinder finder(board);
  const cv::Mat straight = drawn_chessboard(9, 6);
  cv::Mat turned;
  cv::rotate(straight, turned, cv::ROTATE_180);
  BoardMiss why = BoardMiss::none;
  const BoardView a = finder.find(straight, why), b = finder.find(turned, why);
  ASSERT_EQ(a.ids.size(), 54U);
  ASSERT_EQ(b.ids.size(), 54U);
  for (std::size_t i = 0; i < 54; ++i) {
    EXPECT_NEAR(a.pixels[i].x, 639 - b.pixels[i].x, 0.1);
    EXPECT_NEAR(a.pixels[i].y, 479 - b.pixels[i].y, 0.1);
  }
  // Edges between pixels 99 and 100 lie at 99.5.
  const double first_x = std::min(a.pixels[0].x, a.pixels[53].x);
  EXPECT_NEAR(first_x, 99.5, 0.1);
}

TEST(BoardFinder, FindsCharucoAndKnowsAMirroredOne) {
  const BoardOptions board{
      .kind = BoardKind::charuco, .corners_x = 6, .corners_y = 4, .square_mm = 2, .marker_mm = 1.5};
  const auto drawn_board = cv::aruco::CharucoBoard::create(
      7, 5, 2.0F, 1.5F, cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50));
  cv::Mat picture, mirrored;
  drawn_board->draw({700, 520}, picture, 20);
  cv::flip(picture, mirrored, 1);
  const BoardFinder finder(board);
  BoardMiss why = BoardMiss::none;
  const BoardView view = finder.find(picture, why);
  ASSERT_EQ(view.ids.size(), 24U);
  // Neighbours along x lie one square apart to the right, whatever the order of rows.
  EXPECT_EQ(view.ids[1], view.ids[0] + 1);
  EXPECT_GT(view.pixels[1].x, view.pixels[0].x + 50);
  EXPECT_TRUE(finder.find(mirrored, why).empty());
  EXPECT_EQ(why, BoardMiss::mirrored);
}

TEST_F(SessionInput, MixedPictureSizesAreRefused) {
  cv::imwrite((folder_ / "a1.png").string(), cv::Mat(48, 64, CV_8UC3, cv::Scalar(1, 2, 3)));
  cv::imwrite((folder_ / "a2.png").string(), cv::Mat(24, 32, CV_8UC3, cv::Scalar(1, 2, 3)));
  auto input = input_from_path(folder_);
  ASSERT_TRUE(input.has_value()) << input.error().message;
  const auto session = collect(*input, {});
  ASSERT_FALSE(session.has_value());
  EXPECT_EQ(session.error().code, ErrorCode::mismatch);
  EXPECT_THAT(session.error().message, HasSubstr("a2.png"));
}

TEST_F(SessionInput, PosesBesideThePicturesBelongToTheirInstants) {
  cv::imwrite((folder_ / "a1.png").string(), drawn_chessboard(9, 6));
  write("poses.csv", "frame,x_mm,y_mm,z_mm,qw,qx,qy,qz\na1.png,1,2,3,1,0,0,0\n");
  auto input = input_from_path(folder_);
  ASSERT_TRUE(input.has_value()) << input.error().message;
  CollectOptions options;
  options.board = BoardOptions{};
  const auto session = collect(*input, options);
  ASSERT_TRUE(session.has_value()) << session.error().message;
  ASSERT_EQ(session->observations.size(), 1U);
  const PoseAnswer pose = session->pose_at(0, session->observations[0].time);
  ASSERT_TRUE(pose.ok());
  EXPECT_EQ(pose.world_from_sensor.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_NE(session->hash, 0U);
}

TEST_F(SessionInput, AMissingFolderIsSaid) {
  const auto input = input_from_path(folder_ / "nowhere");
  ASSERT_FALSE(input.has_value());
  EXPECT_EQ(input.error().code, ErrorCode::not_found);
}

TEST_F(CalibrationEntries, ValueDateHashVersionAndPreviousValueComeBack) {
  const fs::path file = folder_ / "c.yaml";
  Quality quality;
  quality.used = 7;
  quality.offered = 9;
  quality.unit = "mm";
  quality.residual = 0.25;
  quality.held_out = 0.5;
  quality.parameters = {{"b", 6.5, 0.01, "mm"}};
  quality.left_out = {{"im3.png", "outlier: \"far\" off"}};
  const auto put = [](Calibration& c) {
    const std::string before = std::to_string(c.camera_latency);
    c.camera_latency = 5 * kMillisecond;
    return before;
  };
  ASSERT_TRUE(store(file, thesis_camera_ii(), make_entry("time", "recording x", 0xab, "m", quality), put)
                  .has_value());
  ASSERT_TRUE(store(file, thesis_camera_ii(), make_entry("time", "recording y", 0xcd, "m", quality), put)
                  .has_value());
  const auto loaded = load_calibration(file);
  ASSERT_TRUE(loaded.has_value()) << loaded.error().message;
  EXPECT_EQ(loaded->camera_latency, 5 * kMillisecond);
  const auto entries = read_entries(file);
  ASSERT_TRUE(entries.has_value()) << entries.error().message;
  ASSERT_EQ(entries->size(), 2U);
  const Entry& first = entries->front();
  EXPECT_EQ(first.previous, "0");
  EXPECT_EQ(entries->back().previous, "5000000");
  EXPECT_EQ(first.source, "recording x");
  EXPECT_EQ(first.inputs_hash, "00000000000000ab");
  EXPECT_FALSE(first.version.empty());
  EXPECT_EQ(first.date.size(), std::string("2026-01-01T00:00:00Z").size());
  EXPECT_EQ(first.quality.used, 7U);
  EXPECT_EQ(first.quality.held_out, 0.5);
  ASSERT_EQ(first.quality.parameters.size(), 1U);
  EXPECT_EQ(first.quality.parameters[0].deviation, 0.01);
  ASSERT_EQ(first.quality.left_out.size(), 1U);
  EXPECT_EQ(first.quality.left_out[0].reason, "outlier: \"far\" off");
}

TEST_F(CalibrationEntries, ADamagedFileIsNotOverwritten) {
  write("c.yaml", "%YAML:1.0\n---\nimage_width: 640\n");
  const auto stored = store(folder_ / "c.yaml", thesis_camera_ii(), make_entry("time", "x", 1, "m", {}),
                            [](Calibration&) { return std::string(); });
  ASSERT_FALSE(stored.has_value());
  std::ifstream in(folder_ / "c.yaml");
  const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  EXPECT_EQ(text, "%YAML:1.0\n---\nimage_width: 640\n");
}

constexpr const char* kRos =
    "image_width: 640\nimage_height: 480\ncamera_name: endoscope\ncamera_matrix:\n  rows: 3\n  cols: 3\n"
    "  data: [600.5, 0, 320.25, 0, 601.5, 240.75, 0, 0, 1]\ndistortion_model: plumb_bob\n"
    "distortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [-0.1, 0.02, 0.001, -0.002, 0.5]\n";

TEST_F(CameraFiles, RosCameraInfoIsRead) {
  write("ros.yaml", kRos);
  const auto camera = load_camera((folder_ / "ros.yaml").string());
  ASSERT_TRUE(camera.has_value()) << camera.error().message;
  EXPECT_EQ(camera->width, 640);
  EXPECT_EQ(camera->fx, 600.5);
  EXPECT_EQ(camera->fy, 601.5);
  EXPECT_EQ(camera->cx, 320.25);
  EXPECT_EQ(camera->cy, 240.75);
  EXPECT_EQ(camera->distortion, (std::array<double, 5>{-0.1, 0.02, 0.001, -0.002, 0.5}));
}

TEST_F(CameraFiles, OtherDistortionModelsOfRosAreRefused) {
  std::string text = kRos;
  text.replace(text.find("plumb_bob"), 9, "equidistant");
  write("ros.yaml", text);
  const auto camera = load_camera((folder_ / "ros.yaml").string());
  ASSERT_FALSE(camera.has_value());
  EXPECT_EQ(camera.error().code, ErrorCode::unsupported);
  EXPECT_THAT(camera.error().message, HasSubstr("equidistant"));
}

TEST_F(CameraFiles, PresetsCarryThePrintedNumbers) {
  EXPECT_EQ(load_camera("thesis-camera-i")->fx, 771.3048);
  EXPECT_EQ(load_camera("thesis-camera-ii")->fy, 609.9623);
}

TEST_F(CameraFiles, OurOwnFileIsRead) {
  ASSERT_TRUE(save_calibration(thesis_camera_ii(), folder_ / "c.yaml").has_value());
  const auto camera = load_camera((folder_ / "c.yaml").string());
  ASSERT_TRUE(camera.has_value()) << camera.error().message;
  EXPECT_EQ(camera->fx, 609.9614);
}

}  // namespace
}  // namespace linescope::calibrate
