// linescope-calibrate as a person and a script run it, with a living daemon of the twin.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <filesystem>

#include "common/calibration.hpp"
#include "tests/support/child_process.hpp"
#include "tests/support/finished_run.hpp"

namespace linescope {
namespace {

using testing::ChildProcess;
using testing::Finished;
using ::testing::HasSubstr;
using testing::run_to_end;
using testing::TemporaryFolder;

Finished calibrate(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), LINESCOPE_CALIBRATE);
  return run_to_end(std::move(arguments), std::chrono::seconds(60));
}

TEST(CalibrateProgram, SaysWhatIsMissing) {
  EXPECT_EQ(calibrate({}).code, 2);
  const Finished no_file = calibrate({"camera"});
  EXPECT_EQ(no_file.code, 2);
  EXPECT_THAT(no_file.err, HasSubstr("--calibration FILE"));
  EXPECT_EQ(calibrate({"show", "/nowhere.yaml"}).code, 4);
  EXPECT_EQ(calibrate({"camera", "--from", "/nowhere", "--calibration", "c.yaml"}).code, 5);
  EXPECT_EQ(calibrate({"camera", "--set", "board.corners=9", "--calibration", "c.yaml"}).code, 2);
}

TEST(CalibrateProgram, ImportsAPresetAndShowsWhereItComesFrom) {
  const TemporaryFolder folder;
  const std::string file = folder.path() / "c.yaml";
  ASSERT_EQ(calibrate({"import", "thesis-camera-i", "--calibration", file}).code, 0);
  EXPECT_EQ(load_calibration(file)->camera.fx, 771.3048);
  const Finished shown = calibrate({"show", file});
  EXPECT_EQ(shown.code, 0);
  EXPECT_THAT(shown.out, HasSubstr("from thesis-camera-i"));
  EXPECT_THAT(shown.out, HasSubstr("never calibrated: run linescope-calibrate laser"));
}

/// The board scene of the twin, whose pictures are those of camera II at half its size.
TEST(CalibrateProgram, CalibratesTheCameraOfALivingDaemonAndDraws) {
  const TemporaryFolder folder;
  const std::string segment = testing::unique_segment(), file = folder.path() / "c.yaml";
  ChildProcess daemon({LINESCOPE_ACQUIRE, "--camera", "twin", "--tracker", "twin", "--calibration",
                       "thesis-camera-ii", "--set", "twin.phantom=board", "--set", "twin.scenario=board",
                       "--segment", segment});
  ASSERT_TRUE(testing::eventually([&] { return !testing::leftovers(segment).empty(); }));
  const Finished done = calibrate({"camera", "--segment", segment, "--calibration", file, "--set",
                                   "board.square_mm=1", "--set", "camera.most_pictures=14", "--set",
                                   "camera.every_ms=500", "--plots", folder.path() / "plots"});
  ASSERT_EQ(done.code, 0) << done.err << done.out;
  EXPECT_THAT(done.out, HasSubstr("held out"));
  EXPECT_THAT(done.err, HasSubstr("pictures with a board"));
  EXPECT_NEAR(load_calibration(file)->camera.fx, 609.9614 / 2, 0.01 * 609.9614 / 2);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "plots" / "camera-coverage.png"));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "plots" / "camera-residuals.png"));
  // Four pictures are too few: nothing is stored.
  const Finished refused =
      calibrate({"camera", "--segment", segment, "--calibration", folder.path() / "d.yaml", "--set",
                 "board.square_mm=1", "--set", "camera.most_pictures=4"});
  EXPECT_EQ(refused.code, 9);
  EXPECT_THAT(refused.err, HasSubstr("too few"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "d.yaml"));
  daemon.send(SIGTERM);
  EXPECT_TRUE(daemon.wait(std::chrono::seconds(20)));
  EXPECT_TRUE(testing::leftovers(segment).empty());
}

}  // namespace
}  // namespace linescope
