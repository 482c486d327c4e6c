// linescope-inspect: what it shows, and the exit codes scripts rely on.
#include <gmock/gmock.h>

#include "tests/integration/ipc/publisher_fixture.hpp"

namespace linescope::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Inspect = PublisherTest;

TEST_F(Inspect, ShowsALivingSegment) {
  start_publisher("100");
  const Finished finished = inspect();
  EXPECT_EQ(finished.exit_code, 0) << finished.output;
  EXPECT_THAT(finished.output, AllOf(HasSubstr("life      live"), HasSubstr("state     scanning"),
                                     HasSubstr("made-up lines"), HasSubstr("sensor 1  endoscope"),
                                     HasSubstr("nominal 240 Hz"), HasSubstr("lines_published")));
  EXPECT_THAT(finished.output, Not(HasSubstr("frames_unreadable"))) << "zeros only with --all";
  EXPECT_THAT(inspect({"--all"}).output, AllOf(HasSubstr("frames_unreadable"), HasSubstr("extract")));
}

TEST_F(Inspect, WatchesAsOftenAsAsked) {
  start_publisher("100");
  const Finished finished = inspect({"--watch", "--json", "--times", "3", "--interval", "0.02"});
  EXPECT_EQ(finished.exit_code, 0);
  EXPECT_EQ(std::count(finished.output.begin(), finished.output.end(), '\n'), 3);
}

TEST_F(Inspect, NoSegmentIsThree) {
  const Finished finished = run({LINESCOPE_INSPECT, "no-such-segment"});
  EXPECT_EQ(finished.exit_code, 3);
  EXPECT_THAT(finished.output, HasSubstr("no linescope daemon"));
}

TEST_F(Inspect, ADeadDaemonIsFourAndStillShown) {
  start_publisher("100");
  publisher_->kill();
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  const Finished finished = run({LINESCOPE_INSPECT, name_});
  EXPECT_EQ(finished.exit_code, 4);
  EXPECT_THAT(finished.output,
              AllOf(HasSubstr("silent"), HasSubstr("pose stale"), HasSubstr("lines_published")));
}

TEST_F(Inspect, WhatIsNoSegmentIsFive) {
  std::ofstream("/dev/shm/" + name_) << std::string(5000, 'x');
  const Finished finished = run({LINESCOPE_INSPECT, name_});
  EXPECT_EQ(finished.exit_code, 5);
  EXPECT_THAT(finished.output, HasSubstr("no linescope segment"));
}

TEST_F(Inspect, WrongUsageIsTwo) {
  EXPECT_EQ(run({LINESCOPE_INSPECT, "--no-such-option"}).exit_code, 2);
}

}  // namespace
}  // namespace linescope::testing
