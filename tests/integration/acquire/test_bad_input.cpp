// Bad input: one clear sentence, the right exit code, and nothing left behind.
#include <gtest/gtest.h>

#include <array>
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
    for (int i = 0; i < 4; ++i) write_picture("im" + std::to_string(i) + ".ppm", 720, 480);
    write(poses(),
          "frame,x_mm,y_mm,z_mm,qw,qx,qy,qz\nim0.ppm,0,0,0,1,0,0,0\nim1.ppm,0,0,0,1,0,0,0\nim2.ppm,0,0,0,1,0,"
          "0,0\nim3.ppm,0,0,0,1,0,0,0\n");
    ASSERT_TRUE(save_calibration(thesis_camera_ii(), calibration()));
  }

  std::filesystem::path pictures() const { return folder_.path() / "pictures"; }
  std::filesystem::path poses() const { return folder_.path() / "poses.csv"; }
  std::filesystem::path calibration() const { return folder_.path() / "calibration.yaml"; }

  static void write(const std::filesystem::path& file, const std::string& text) {
    std::ofstream(file) << text;
  }

  /// A green line on black, as a PPM of our own making: no encoder is needed to write one.
  void write_picture(const std::string& name, int width, int height) const {
    std::ofstream out(pictures() / name, std::ios::binary);
    out << "P6\n" << width << ' ' << height << "\n255\n";
    const std::array<char, 5> profile{40, 110, static_cast<char>(180), 110, 40};
    for (int v = 0; v < height; ++v)
      for (int u = 0; u < width; ++u) {
        const int d = v - (height * 5 / 8 - 2);
        const bool lit = d >= 0 && d < 5 && u > 20 && u < width - 20;
        out.put(4).put(lit ? profile[static_cast<std::size_t>(d)] : 4).put(4);
      }
  }

  /// Poses by time, one row per picture at 30 Hz, and one more behind the last picture.
  static std::string rows_by_time(const std::vector<std::string>& times) {
    std::string text = "time_s,station,x_mm,y_mm,z_mm,qw,qx,qy,qz\n";
    for (const std::string& time : times) text += time + ",1,0,0,0,1,0,0,0\n";
    return text;
  }

  /// The daemon with these arguments stays after the end, so that its segment can be read.
  static std::vector<std::string> staying(std::vector<std::string> args) {
    args.pop_back();
    return args;
  }

  /// Runs until `lines` lines are there and no more come; says what was complained about.
  void expect_lines(std::uint64_t lines, const std::vector<std::string>& words) {
    DaemonUnderTest daemon(staying(arguments()));
    auto reader = daemon.attach();
    ASSERT_TRUE(reader) << daemon.process().standard_error();
    DaemonStatus status;
    ASSERT_TRUE(eventually([&] {
      return reader->status(status) == ReadOutcome::ok && status.reason == "the recording is through";
    })) << status.reason;
    EXPECT_EQ(counter(*reader, Counter::lines_published), lines) << daemon.process().standard_error();
    EXPECT_EQ(whole_scan(*reader).lines.size(), lines) << "what was good stays";
    for (const std::string& word : words)
      EXPECT_NE(daemon.process().standard_error().find(word), std::string::npos)
          << word << " missing in: " << daemon.process().standard_error();
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
  expect_lines(4, {});
  write(poses(), rows_by_time({"0", "0.04", "0.08", "0.12"}));
  expect_lines(4, {});
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

TEST_F(BadInput, NoSuchVideo) {
  auto args = arguments();
  args[1] = "/no/such/scan.mkv";
  args[3] = "none";
  expect_refused(args, 5, {"there is no file or folder /no/such/scan.mkv"});
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
  write(poses(), "frame,x_mm,y_mm,z_mm,qw,qx,qy\nim0.ppm,0,0,0,1,0,0\n");
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

TEST_F(BadInput, AllMistakesOfAConfigurationFileAreToldWithTheirLines) {
  const auto file = folder_.path() / "knee.toml";
  write(
      file,
      "[camera]\nrate_hx = 30\nwidth = \"wide\"\ngain = 1e9\n[run]\npace = \"fats\"\n[camra]\nrate_hz = 1\n");
  const Outcome outcome = run_daemon_to_end({"--config", file, "--check"});
  EXPECT_EQ(outcome.exit_code, 3);
  for (const char* words :
       {"knee.toml:2: unknown key camera.rate_hx; did you mean camera.rate_hz?",
        "knee.toml:3: camera.width must be a whole number", "knee.toml:4: camera.gain is",
        "knee.toml:6: run.pace is \"fats\"", "knee.toml:7: unknown section camra; did you mean camera?"})
    EXPECT_NE(outcome.said.find(words), std::string::npos) << words << " missing in: " << outcome.said;
}

TEST_F(BadInput, RolesThatShareAStation) {
  expect_refused({"--set", "tracker.object_station=1"}, 3, {"share a station"});
}

TEST_F(BadInput, AnUnreadablePictureInTheMiddleIsCountedAndTheRestIsUsed) {
  write(pictures() / "im1.ppm", "broken");
  expect_lines(3, {"im1.ppm"});
}

TEST_F(BadInput, APictureOfAnotherSizeIsCountedAndTheRestIsUsed) {
  write_picture("im2.ppm", 320, 240);
  expect_lines(3, {"im2.ppm"});
}

TEST_F(BadInput, PicturesThatAreAllOfAnotherSizeGiveNothingAndSaySo) {
  for (int i = 0; i < 4; ++i) write_picture("im" + std::to_string(i) + ".ppm", 320, 240);
  DaemonUnderTest daemon(staying(arguments()));
  auto reader = daemon.attach();
  ASSERT_TRUE(reader) << daemon.process().standard_error();
  EXPECT_TRUE(eventually([&] { return counter(*reader, Counter::frames_wrong_size) == 4; }));
  EXPECT_EQ(counter(*reader, Counter::lines_published), 0u);
  const std::string said = daemon.process().standard_error();
  EXPECT_NE(said.find("320x240"), std::string::npos) << said;
  EXPECT_NE(said.find("720x480"), std::string::npos) << said;
}

TEST_F(BadInput, ABrokenPoseRowCostsOnePictureOnly) {
  for (const char* row : {"im1.ppm,nan,0,0,1,0,0,0", "im1.ppm,0,0,inf,1,0,0,0", "im1.ppm,0,0,0,0,0,0,0"}) {
    SCOPED_TRACE(row);
    write(poses(), std::string("frame,x_mm,y_mm,z_mm,qw,qx,qy,qz\nim0.ppm,0,0,0,1,0,0,0\n") + row +
                       "\nim2.ppm,0,0,0,1,0,0,0\nim3.ppm,0,0,0,1,0,0,0\n");
    expect_lines(3, {"poses.csv:3"});
  }
}

TEST_F(BadInput, ARowOutOfOrderEndsThePosesAndWhatCameBeforeStays) {
  write(poses(), rows_by_time({"0", "0.04", "0.07", "0.05", "0.12"}));
  expect_lines(3, {"poses.csv:5"});  // pictures at 0, 1/30 and 2/30 s
}

TEST_F(BadInput, ALogFileThatCannotBeWritten) {
  auto args = arguments();
  args.insert(args.end(), {"--log-file", "/no/such/folder/acquire.log"});
  expect_refused(args, 3, {"/no/such/folder/acquire.log", "cannot be written"});
}

}  // namespace
}  // namespace linescope::testing
