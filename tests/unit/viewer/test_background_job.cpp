// Longer work beside the display.
#include <gtest/gtest.h>

#include "tests/support/child_process.hpp"
#include "viewer/background_job.hpp"

namespace linescope::testing {
namespace {

TEST(BackgroundJob, EndsInTheOwnersThread) {
  BackgroundJob job;
  std::thread::id worked, ended;
  ASSERT_TRUE(job.start("Working", [&](JobControl& control) {
    worked = std::this_thread::get_id();
    control.go_on(0.5);
    return [&] { ended = std::this_thread::get_id(); };
  }));
  EXPECT_EQ(job.title(), "Working");
  ASSERT_TRUE(eventually([&] { return job.poll(), !job.busy(); }));
  EXPECT_EQ(ended, std::this_thread::get_id());
  EXPECT_NE(worked, ended);
  EXPECT_EQ(job.share(), 0.5);
}

TEST(BackgroundJob, OneAtATime) {
  BackgroundJob job;
  std::atomic<bool> go{false};
  ASSERT_TRUE(job.start("First", [&](JobControl&) {
    while (!go) std::this_thread::yield();
    return BackgroundJob::Ending();
  }));
  EXPECT_FALSE(job.start("Second", [](JobControl&) { return BackgroundJob::Ending(); }));
  EXPECT_EQ(job.title(), "First");
  go = true;
  ASSERT_TRUE(eventually([&] { return job.poll(), !job.busy(); }));
  EXPECT_TRUE(job.start("Second", [](JobControl&) { return BackgroundJob::Ending(); }));
}

TEST(BackgroundJob, IsGivenUpWhenAskedAndWithItsOwner) {
  bool ending_called = false;
  const auto endless = [&](JobControl& control) -> BackgroundJob::Ending {
    while (control.go_on(0)) std::this_thread::yield();
    return [&] { ending_called = true; };
  };
  {
    BackgroundJob job;
    job.start("Endless", endless);
    job.cancel();
    ASSERT_TRUE(eventually([&] { return job.poll(), !job.busy(); }));
    EXPECT_TRUE(ending_called);
    ending_called = false;
    job.start("Endless again", endless);
  }
  EXPECT_FALSE(ending_called) << "nobody is there any more to hear of it";
}

}  // namespace
}  // namespace linescope::testing
