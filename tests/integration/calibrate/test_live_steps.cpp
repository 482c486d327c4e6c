// The steps that need motion, live: linescope-acquire plays the twin, linescope-calibrate reads its segment.
// How long it takes depends on the machine; what is found does not: each step ends with enough data.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "common/units.hpp"
#include "ipc/segment_reader.hpp"
#include "tests/integration/acquire/daemon_under_test.hpp"
#include "tests/support/finished_run.hpp"
#include "tools/calibrate/record_entry.hpp"

namespace linescope {
namespace {

using testing::ChildProcess;
using testing::DaemonUnderTest;
using testing::Finished;
using ::testing::HasSubstr;
using testing::run_to_end;
using testing::TemporaryFolder;

/// A living twin, a calibration file that holds its true values but those to be found, and the program.
class LiveStep : public ::testing::Test {
 protected:
  void start(std::vector<std::string> keys) {
    std::vector<std::string> arguments{"--camera", "twin", "--tracker", "twin"};
    for (const std::string& key : keys) arguments.insert(arguments.end(), {"--set", key});
    daemon_ = std::make_unique<DaemonUnderTest>(arguments);
    auto reader = daemon_->attach();
    ASSERT_TRUE(reader) << daemon_->process().standard_error();
    std::string yaml;
    ASSERT_TRUE(testing::eventually([&] { return reader->calibration(yaml) == ReadOutcome::ok; }));
    const auto truth = calibration_from_text(yaml, "of the twin");
    ASSERT_TRUE(truth) << truth.error().message;
    truth_ = *truth;
  }

  /// What the file says before the step.
  void begin_with(const Calibration& calibration) {
    const auto put = [&](Calibration& c) { return c = calibration, std::string(); };
    ASSERT_TRUE(
        calibrate::store(file(), calibration, calibrate::make_entry("camera", "truth", 0, "", {}), put));
  }

  Finished calibrate(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), LINESCOPE_CALIBRATE);
    arguments.insert(arguments.end(), {"--segment", daemon_->segment(), "--calibration", file(), "--plots",
                                       (folder_.path() / "plots").string()});
    return run_to_end(std::move(arguments));
  }

  Calibration found() {
    const auto calibration = load_calibration(file());
    EXPECT_TRUE(calibration) << calibration.error().message;
    return calibration ? *calibration : Calibration{};
  }

  bool drew(const char* name) const { return std::filesystem::exists(folder_.path() / "plots" / name); }
  std::string file() const { return folder_.path() / "c.yaml"; }

  TemporaryFolder folder_;
  std::unique_ptr<DaemonUnderTest> daemon_;
  Calibration truth_;
};

TEST_F(LiveStep, HarvesterFindsTheTip) {
  start({"twin.scenario=pivot"});
  Calibration before = truth_;
  before.harvester.tip = {-100, 0, 0};
  begin_with(before);
  const Finished run = calibrate({"harvester", "--set", "harvester.most_poses=1200"});
  ASSERT_EQ(run.code, 0) << run.err << run.out;
  EXPECT_THAT(run.err, HasSubstr("poses good, turned by up to"));
  EXPECT_LT((found().harvester.tip - truth_.harvester.tip).norm(), 1.5);
  EXPECT_TRUE(drew("harvester-pivot.png"));
}

TEST_F(LiveStep, TimeFindsTheLatencyOfTheCamera) {
  start({"twin.phantom=board", "twin.scenario=shake", "twin.led=150", "twin.laser=false",
         "twin.camera_latency_ms=12.3"});
  Calibration before = truth_;
  before.camera_latency = 0;
  begin_with(before);
  const Finished run =
      calibrate({"time", "--set", "board.square_mm=1", "--set", "board.corners_x=9", "--set",
                 "board.corners_y=6", "--set", "time.most_pictures=80", "--set", "time.least_pictures=50"});
  ASSERT_EQ(run.code, 0) << run.err << run.out;
  EXPECT_NEAR(milliseconds_from(found().camera_latency), 12.3, 1);
  EXPECT_TRUE(drew("time-motion.png"));
}

TEST_F(LiveStep, TimeRefusesACameraOfAnotherPictureSize) {
  start({"twin.phantom=board", "twin.scenario=shake", "twin.led=150", "twin.laser=false"});
  Calibration before = truth_;
  before.camera.width *= 2, before.camera.height *= 2, before.camera.fx *= 2, before.camera.fy *= 2;
  before.camera.cx *= 2, before.camera.cy *= 2;
  begin_with(before);
  const Finished run = calibrate({"time", "--set", "board.square_mm=1", "--set", "time.most_pictures=3"});
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.err, HasSubstr("run the camera step first"));
}

/// At 30 pictures a second these lines are the five seconds of a pass to and fro: wherever in it the program
/// begins, and however many pictures a slow machine leaves out, it sees two passes.
const std::vector<std::string> kSweeps{"twin.phantom=cylinder-50", "twin.scenario=sweeps",
                                       "twin.noise=ideal"};
const std::vector<std::string> kCheckOfCylinder{"check", "--set", "check.shape=cylinder", "--set",
                                                "check.most_lines=150"};

TEST_F(LiveStep, CheckJudgesAScanAndTheTrackerAtRest) {
  start(kSweeps);
  begin_with(truth_);
  const Finished good = calibrate(kCheckOfCylinder);
  ASSERT_EQ(good.code, 0) << good.err << good.out;
  EXPECT_THAT(good.out, HasSubstr("verdict: good"));
  EXPECT_THAT(good.out, HasSubstr("sensor 2 at rest: drift"));
  EXPECT_TRUE(drew("check-surface.png"));
  EXPECT_TRUE(drew("check-still.png"));
}

// The laser plane in the file is half a millimetre off: the daily check has to see it.
TEST_F(LiveStep, CheckRefusesAnInstrumentThatIsOff) {
  start(kSweeps);
  Calibration off = truth_;
  off.laser.offset += 0.5;
  begin_with(off);
  const Finished run = calibrate(kCheckOfCylinder);
  EXPECT_EQ(run.code, 9) << run.out;
  EXPECT_THAT(run.err, HasSubstr("error above limit"));
  EXPECT_THAT(run.err, HasSubstr("bias"));
}

// As a machine does that has something better to do for a moment.
TEST_F(LiveStep, ADaemonThatPausesForAMomentIsWaitedFor) {
  start({"twin.scenario=pivot"});
  begin_with(truth_);
  ChildProcess program({LINESCOPE_CALIBRATE, "harvester", "--segment", daemon_->segment(), "--calibration",
                        file(), "--set", "harvester.most_poses=1200"});
  ASSERT_TRUE(
      testing::eventually([&] { return program.standard_error().find("poses good") != std::string::npos; }));
  daemon_->process().send(SIGSTOP);
  std::this_thread::sleep_for(std::chrono::seconds(1));
  daemon_->process().send(SIGCONT);
  const auto end = program.wait(std::chrono::seconds(60));
  ASSERT_TRUE(end);
  EXPECT_EQ(end->code, 0) << program.standard_error();
}

TEST_F(LiveStep, ADaemonThatDiesEndsTheStepWithASentence) {
  start({"twin.scenario=pivot"});
  begin_with(truth_);
  std::vector<std::string> command{LINESCOPE_CALIBRATE, "harvester",     "--segment",
                                   daemon_->segment(),  "--calibration", file()};
  ChildProcess program(command);
  ASSERT_TRUE(
      testing::eventually([&] { return program.standard_error().find("poses good") != std::string::npos; }));
  daemon_->process().send(SIGKILL);
  const auto end = program.wait(std::chrono::seconds(30));
  ASSERT_TRUE(end);
  EXPECT_EQ(end->code, 5);
  EXPECT_THAT(program.standard_error(), HasSubstr("nothing was calibrated"));
}

}  // namespace
}  // namespace linescope
