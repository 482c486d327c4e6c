// Nine pictures of a scanner on a robot, through the program: what is good is stored, what is not is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/calibration.hpp"
#include "tests/support/child_process.hpp"
#include "tests/support/shared_data.hpp"

namespace linescope {
namespace {

using testing::ChildProcess;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

struct Outcome {
  int code = -1;
  std::string out, err;
};

/// The board of 8 by 7 squares of 10 mm; a laser without colour whose line runs from top to bottom.
Outcome calibrate(const std::string& step, const std::string& file, std::vector<std::string> more = {}) {
  std::vector<std::string> arguments{LINESCOPE_CALIBRATE,
                                     step,
                                     "--calibration",
                                     file,
                                     "--from",
                                     testing::shared_data("robot-scanner/frames").string(),
                                     "--set",
                                     "board.corners_x=7",
                                     "--set",
                                     "board.corners_y=6",
                                     "--set",
                                     "board.square_mm=10"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  ChildProcess child(arguments);
  const auto end = child.wait(std::chrono::seconds(100));
  return {end && !end->signalled ? end->code : -1, child.standard_output(), child.standard_error()};
}

/// The line lies up to ten squares beside the corners, from which the board's plane is carried on to it
/// (docs/calibrating.md): the residual is too large.
TEST(RobotScanner, TheCameraIsGoodAndTheLaserBesideTheBoardIsRefused) {
  LINESCOPE_NEEDS_SHARED_DATA();
  const TemporaryFolder folder;
  const std::string file = folder.path() / "robot.yaml";
  const Outcome camera = calibrate("camera", file);
  ASSERT_EQ(camera.code, 0) << camera.err << camera.out;
  EXPECT_NEAR(load_calibration(file)->camera.fx, 2400, 60) << "about 2400 px, 24 px of deviation";

  const Outcome refused = calibrate(
      "laser", file,
      {"--set", "laser.colour=mono", "--set", "laser.axis=row", "--set", "laser.margin_squares=12"});
  EXPECT_EQ(refused.code, 9) << refused.out;
  EXPECT_THAT(refused.err, HasSubstr("error above limit: residual 0.6"));
  EXPECT_THAT(refused.err, HasSubstr("0.25 mm are allowed"));
  EXPECT_THAT(refused.out, HasSubstr("robust plane"));
  EXPECT_EQ(refused.err.find("stored in"), std::string::npos);
}

}  // namespace
}  // namespace linescope
