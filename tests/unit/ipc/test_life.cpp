// How a reader learns that its writer died, ended, was replaced or removed; waiting and waking.
#include <gmock/gmock.h>

#include <thread>

#include "ipc/heartbeat.hpp"
#include "tests/unit/ipc/raw_object.hpp"
#include "tests/unit/ipc/segment_fixture.hpp"

namespace linescope::testing {
namespace {

using ::testing::HasSubstr;
using LifeTest = SegmentTest;

TEST_F(LifeTest, AFreshHeartbeatIsLifeAndAnOldOneIsSilence) {
  const Nanoseconds beat = monotonic_now();
  ASSERT_TRUE(writer_->heartbeat(beat));
  EXPECT_EQ(reader_->life(beat + kDeadAfter - 1), Life::live);
  EXPECT_EQ(reader_->life(beat + kDeadAfter), Life::silent);
  const LifeReport report = reader_->report(beat + kSecond);
  EXPECT_EQ(report.silent_for, kSecond);
  EXPECT_THAT(report.text, HasSubstr("silent for 1.0 s"));
  ASSERT_TRUE(writer_->heartbeat(beat + 2 * kSecond));
  EXPECT_EQ(reader_->life(beat + 2 * kSecond), Life::live) << "a writer may come back";
  EXPECT_TRUE(reader_->report(beat + 2 * kSecond).text.empty());
}

TEST_F(LifeTest, SilenceIsNoticedWithinTheTimeThatIsPromised) {
  EXPECT_LE(kDeadAfter + 50 * kMillisecond, 200 * kMillisecond) << "looking every 50 ms is enough for 0.2 s";
  EXPECT_GE(kDeadAfter, 3 * kHeartbeatAtLeastEvery) << "one missed beat is no death";
}

TEST_F(LifeTest, AHeartbeatFromTheFutureIsNone) {
  writer_->heartbeat(monotonic_now() + 3600 * kSecond);
  EXPECT_EQ(reader_->life(monotonic_now()), Life::silent);
}

TEST_F(LifeTest, LateHeartbeatsAreCounted) {
  const Nanoseconds now = monotonic_now();
  writer_->heartbeat(now);
  writer_->heartbeat(now + 50 * kMillisecond);
  EXPECT_EQ(writer_->counted(Counter::heartbeats_late), 0U);
  writer_->heartbeat(now + 101 * kMillisecond);
  EXPECT_EQ(writer_->counted(Counter::heartbeats_late), 1U);
}

TEST_F(LifeTest, AnOrderlyEndIsToldAndLeavesNothing) {
  writer_.reset();
  EXPECT_EQ(reader_->life(monotonic_now()), Life::closed);
  EXPECT_THAT(reader_->report(monotonic_now()).text, HasSubstr("has ended"));
  EXPECT_FALSE(exists(name_));
  EXPECT_FALSE(exists(control_name(name_)));
}

TEST_F(LifeTest, WhatWasPublishedStaysReadableAfterTheEnd) {
  writer_->set_scanning(true);
  publish(5, 20);
  writer_.reset();
  LineCursor cursor;
  LineBatch batch;
  ASSERT_EQ(reader_->read_lines(cursor, batch), ReadOutcome::ok);
  expect_points(batch.points_of(batch.lines[0]), 5, 20);
}

TEST_F(LifeTest, ARemovedNameIsNoticedByBothSides) {
  ASSERT_EQ(::shm_unlink(name_.c_str()), 0);
  const Nanoseconds now = monotonic_now();
  const auto beat = writer_->heartbeat(now);
  ASSERT_FALSE(beat);
  EXPECT_EQ(beat.error().code, ErrorCode::gone);
  EXPECT_THAT(beat.error().message, HasSubstr("removed"));
  EXPECT_EQ(reader_->life(now + 100 * kMillisecond), Life::removed);
}

TEST_F(LifeTest, AnotherSegmentOfTheSameNameIsNoticed) {
  auto bytes = RawObject::bytes_of(name_);
  const RawObject other(name_);
  other.set(bytes);  // another object under our name
  const Nanoseconds now = monotonic_now();
  ASSERT_FALSE(writer_->heartbeat(now));
  EXPECT_EQ(reader_->life(now + 100 * kMillisecond), Life::replaced);
  EXPECT_THAT(reader_->report(now + 100 * kMillisecond).text, HasSubstr("attach again"));
  writer_.reset();
  EXPECT_TRUE(exists(name_)) << "a writer does not remove what is not its own";
}

TEST_F(LifeTest, AMappingThatWasCutShortIsReportedNotRead) {
  ASSERT_EQ(::truncate(("/dev/shm/" + name_).c_str(), 0), 0);
  PoseSample pose;
  DaemonStatus status;
  LineCursor cursor;
  LineBatch batch;
  EXPECT_EQ(reader_->latest_pose(0, pose), ReadOutcome::corrupt);
  EXPECT_EQ(reader_->status(status), ReadOutcome::corrupt);
  EXPECT_EQ(reader_->read_lines(cursor, batch), ReadOutcome::corrupt);
  EXPECT_TRUE(reader_->counters().empty());
  EXPECT_EQ(reader_->life(monotonic_now()), Life::damaged);
  EXPECT_FALSE(reader_->wait(Topic::all, kSecond));
  ::truncate(("/dev/shm/" + name_).c_str(), static_cast<off_t>(segment_bytes(small_segment(name_))));
}

TEST_F(LifeTest, NewsAreToldOncePerTopic) {
  reader_->news(Topic::all);
  EXPECT_FALSE(reader_->news(Topic::all));
  writer_->publish_pose({});
  EXPECT_FALSE(reader_->news(Topic::lines | Topic::pictures | Topic::status));
  EXPECT_TRUE(reader_->news(Topic::poses));
  EXPECT_FALSE(reader_->news(Topic::poses));
  writer_->set_scanning(true);  // also begins the first scan
  EXPECT_TRUE(reader_->news(Topic::status));
  EXPECT_TRUE(reader_->news(Topic::lines));
  publish(1, 5);
  EXPECT_TRUE(reader_->news(Topic::lines));
  writer_->set_state(DaemonState::scanning, "");
  EXPECT_TRUE(reader_->news(Topic::status));
}

TEST_F(LifeTest, WaitReturnsAtOnceWhenThereIsNews) {
  publish(1, 5);
  EXPECT_TRUE(reader_->wait(Topic::all, 3600 * kSecond));
}

TEST_F(LifeTest, WaitEndsWithItsTimeWhenThereIsNone) {
  const Heartbeat heartbeat(*writer_);
  reader_->news(Topic::all);
  const Nanoseconds start = monotonic_now();
  EXPECT_FALSE(reader_->wait(Topic::all, 120 * kMillisecond));
  EXPECT_GE(monotonic_now() - start, 120 * kMillisecond);
}

TEST_F(LifeTest, WaitEndsWhenTheWriterFallsSilent) {
  writer_->heartbeat(monotonic_now());
  reader_->news(Topic::all);
  EXPECT_FALSE(reader_->wait(Topic::all, 3600 * kSecond));
  EXPECT_EQ(reader_->life(monotonic_now()), Life::silent);
}

class Waking : public SegmentTest, public ::testing::WithParamInterface<bool> {};

TEST_P(Waking, ASleeperIsWokenByWhatItSleepsFor) {
  const Heartbeat heartbeat(*writer_);
  auto attached = SegmentReader::attach({.name = name_, .wake_ups = GetParam()});
  ASSERT_TRUE(attached);
  attached->news(Topic::all);
  writer_->set_scanning(true);
  attached->news(Topic::all);
  std::thread publisher([&] {
    for (int i = 0; i < 50; ++i) {
      writer_->publish_pose({});  // nobody sleeps for poses
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    publish(1, 5);
  });
  EXPECT_TRUE(attached->wait(Topic::lines, 3600 * kSecond));
  publisher.join();
  LineCursor cursor;
  LineBatch batch;
  EXPECT_EQ(attached->read_lines(cursor, batch), ReadOutcome::ok);
}
INSTANTIATE_TEST_SUITE_P(WithAndWithoutControlSegment, Waking, ::testing::Bool());

TEST_F(LifeTest, AnEndWakesWhoSleeps) {
  auto heartbeat = std::make_unique<Heartbeat>(*writer_);
  reader_->news(Topic::all);
  std::thread ender([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    heartbeat.reset();
    writer_.reset();
  });
  EXPECT_FALSE(reader_->wait(Topic::all, 3600 * kSecond));
  ender.join();
  EXPECT_EQ(reader_->life(monotonic_now()), Life::closed);
}

}  // namespace
}  // namespace linescope::testing
