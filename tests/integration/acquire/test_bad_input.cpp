// Bad input: one clear sentence, the right exit code, and nothing left behind.
#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/core.hpp>

#include "common/calibration.hpp"
#include "tests/integration/acquire/daemon_under_test.hpp"

namespace linescope::testing {
namespace {

/// A folder with pictures and everything else a scan needs, to be spoilt piece by piece.
class BadInput : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(pictures());
    for (int i = 0; i < 4; ++i) write_picture("im" + std::to_string(i) + ".pgm", 720, 480);
    write(poses(),
          "frame,x_mm,y_mm,z_mm,qw,qx,qy,qz\nim0.pgm,0,0,0,1,0,0,0\nim1.pgm,0,0,0,1,0,0,0\nim2.pgm,0,0,0,1,0,"
          "0,0\nim3.pgm,0,0,0,1,0,0,0\n");
    ASSERT_TRUE(save_calibration(thesis_camera_ii(), calibration()));
  }

  std::filesystem::path pictures() const { return folder_.path() / "pictures"; }
  std::filesystem::path poses() const { return folder_.path() / "poses.csv"; }
  std::filesystem::path calibration() const { return folder_.path() / "calibration.yaml"; }

  static void write(const std::filesystem::path& file, const std::string& text) {
    std::ofstream(file) << text;
  }

  /// A PGM of our own making: no encoder is needed to write one.
  void write_picture(const std::string& name, int width, int height) const {
    std::ofstream out(pictures() / name, std::ios::binary);
    out << "P5\n"
        << width << ' ' << height << "\n255\n"
        << std::string(static_cast<std::size_t>(width * height), '\x20');
  }

  /// Replaces a line of the calibration that begins with `key`.
  void spoil_calibration(const std::string& from, const std::string& to) const {
    std::ifstream in(calibration());
    std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from << " is not in\n" << text;
    text.replace(at, from.size(), to);
    write(calibration(), text);
  }

  std::vector<std::string> arguments() const {
    return {"--camera",    pictures(), "--tracker", poses(),        "--calibration",
            calibration(), "--scan",   "--fast",    "--exit-at-end"};
  }

  /// Ends with `code` and one line on standard error that names `words`.
  void expect_refused(std::vector<std::string> args, int code, const std::vector<std::string>& words) const {
    const Outcome outcome = run_daemon_to_end(std::move(args));
    EXPECT_EQ(outcome.exit_code, code) << outcome.said;
    for (const std::string& word : words)
      EXPECT_NE(outcome.said.find(word), std::string::npos) << word << " missing in: " << outcome.said;
    EXPECT_EQ(std::count(outcome.said.begin(), outcome.said.end(), '\n'), 1) << outcome.said;
  }

  TemporaryFolder folder_;
};

TEST_F(BadInput, GoodInputIsAccepted) {
  EXPECT_EQ(run_daemon_to_end(arguments()).exit_code, 0);
}

TEST_F(BadInput, NoCamera) {
  expect_refused({"--camera", "/dev/video99", "--tracker", "none", "--calibration", calibration()}, 5,
                 {"/dev/video99"});
}

TEST_F(BadInput, NoSuchFolder) {
  auto args = arguments();
  args[1] = "/no/such/folder";
  expect_refused(args, 5, {"/no/such/folder"});
}

TEST_F(BadInput, EmptyFolder) {
  const auto empty = folder_.path() / "empty";
  std::filesystem::create_directory(empty);
  auto args = arguments();
  args[1] = empty;
  expect_refused(args, 5, {"empty"});
}

TEST_F(BadInput, NoPoseFile) {
  auto args = arguments();
  args[3] = "/no/such/poses.csv";
  expect_refused(args, 6, {"/no/such/poses.csv"});
}

TEST_F(BadInput, PoseFileWithoutAColumn) {
  write(poses(), "frame,x_mm,y_mm,z_mm,qw,qx,qy\nim0.pgm,0,0,0,1,0,0\n");
  expect_refused(arguments(), 6, {"poses.csv", "qz"});
}

TEST_F(BadInput, NoCalibration) {
  auto args = arguments();
  args[5] = "/no/such/calibration.yaml";
  expect_refused(args, 4, {"/no/such/calibration.yaml", "no such file"});
}

TEST_F(BadInput, PicturesWithoutCalibration) {
  expect_refused({"--camera", pictures(), "--tracker", poses()}, 3, {"--calibration"});
}

TEST_F(BadInput, CalibrationThatIsNoYaml) {
  write(calibration(), "this is { not yaml");
  expect_refused(arguments(), 4, {"calibration.yaml"});
}

TEST_F(BadInput, SingularCameraMatrix) {
  spoil_calibration("6.0996140000000003e+02", "0.");
  expect_refused(arguments(), 4, {"calibration.yaml", "singular"});
}

TEST_F(BadInput, FocalLengthInOtherUnits) {
  spoil_calibration("6.0996140000000003e+02", "6.0996140000000003e-01");
  spoil_calibration("6.0996230000000003e+02", "6.0996230000000003e-01");
  expect_refused(arguments(), 4, {"calibration.yaml", "pixels"});
}

TEST_F(BadInput, BaselineOfSixMetres) {
  Calibration c = thesis_camera_ii();
  c.laser.offset *= 1000;
  EXPECT_FALSE(save_calibration(c, folder_.path() / "refused.yaml"));
  // The plane's last number is its distance, written with an exponent: six metres instead of six millimetres.
  std::ifstream in(calibration());
  std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  const auto exponent = text.rfind("e+00", text.find(']', text.find("laser_plane")));
  ASSERT_NE(exponent, std::string::npos) << text;
  text.replace(exponent, 4, "e+03");
  write(calibration(), text);
  expect_refused(arguments(), 4, {"calibration.yaml", "millimetres"});
}

TEST_F(BadInput, UnknownOptionAndUnknownKey) {
  expect_refused({"--no-such-option"}, 2, {"--no-such-option", "--help"});
  expect_refused({"--set", "laser.color=red"}, 2, {"laser.color", "laser.colour"});
  write(folder_.path() / "a.toml", "[laser]\ncolor = \"red\"\n");
  expect_refused({"--config", folder_.path() / "a.toml"}, 3, {"a.toml:2", "laser.colour"});
}

TEST_F(BadInput, RolesThatShareAStation) {
  expect_refused({"--set", "tracker.object_station=0"}, 3, {"share a station"});
}

TEST_F(BadInput, AnUnreadablePictureInTheMiddleIsCountedAndTheRestIsUsed) {
  write(pictures() / "im1.pgm", "broken");
  auto args = arguments();
  args.pop_back();  // stays after the end, so that the counters can be read
  DaemonUnderTest daemon(args);
  auto reader = daemon.attach();
  ASSERT_TRUE(reader) << daemon.process().standard_error();
  EXPECT_TRUE(eventually([&] { return counter(*reader, Counter::frames_received) == 3; }));
  EXPECT_TRUE(eventually([&] { return counter(*reader, Counter::frames_unreadable) == 1; }));
  EXPECT_NE(daemon.process().standard_error().find("im1.pgm"), std::string::npos);
}

TEST_F(BadInput, APictureOfAnotherSizeIsCountedAndTheRestIsUsed) {
  write_picture("im2.pgm", 320, 240);
  auto args = arguments();
  args.pop_back();
  DaemonUnderTest daemon(args);
  auto reader = daemon.attach();
  ASSERT_TRUE(reader) << daemon.process().standard_error();
  EXPECT_TRUE(eventually([&] { return counter(*reader, Counter::frames_received) == 3; }));
  EXPECT_TRUE(eventually([&] { return counter(*reader, Counter::frames_wrong_size) == 1; }));
  EXPECT_NE(daemon.process().standard_error().find("im2.pgm"), std::string::npos);
}

TEST_F(BadInput, ABrokenPoseRowCostsOnePictureOnly) {
  write(poses(),
        "frame,x_mm,y_mm,z_mm,qw,qx,qy,qz\nim0.pgm,0,0,0,1,0,0,0\nim1.pgm,nan,0,0,1,0,0,0\nim2.pgm,0,0,0,1,0,"
        "0,0\nim3.pgm,0,0,0,1,0,0,0\n");
  auto args = arguments();
  args.pop_back();
  DaemonUnderTest daemon(args);
  auto reader = daemon.attach();
  ASSERT_TRUE(reader) << daemon.process().standard_error();
  EXPECT_TRUE(eventually([&] { return counter(*reader, Counter::frames_received) == 4; }));
  EXPECT_NE(daemon.process().standard_error().find("poses.csv:3"), std::string::npos);
}

}  // namespace
}  // namespace linescope::testing
