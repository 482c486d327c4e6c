// Starting a writer where something lies under the name already, and where there is no room.
#include <gmock/gmock.h>
#include <sys/statvfs.h>
#include <sys/wait.h>

#include "ipc/heartbeat.hpp"
#include "ipc/process_identity.hpp"
#include "tests/unit/ipc/raw_object.hpp"
#include "tests/unit/ipc/segment_fixture.hpp"

namespace linescope::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class Claim : public ::testing::Test {
 protected:
  const std::string name_ = unique_segment_name();
  const SegmentOptions options_ = small_segment(name_);

  /// A child makes the segment and dies without tidying up. With `reap` its pid is free again afterwards.
  void leave_a_corpse() {
    const pid_t child = ::fork();
    if (child == 0) {
      auto writer = SegmentWriter::create(options_);
      if (!writer) ::_exit(1);
      writer->set_scanning(true);
      writer->publish_line(info_for(1), points_for(1, 10));
      ::kill(::getpid(), SIGKILL);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status));
    ASSERT_TRUE(exists(name_));
  }
  void TearDown() override {
    ::shm_unlink(name_.c_str());
    ::shm_unlink(control_name(name_).c_str());
  }
};

TEST_F(Claim, ALivingWriterIsLeftAloneAndNamed) {
  auto first = SegmentWriter::create(options_);
  ASSERT_TRUE(first);
  const Heartbeat heartbeat(*first);
  const auto second = SegmentWriter::create(options_);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, ErrorCode::busy);
  EXPECT_THAT(second.error().message,
              AllOf(HasSubstr("already running"), HasSubstr("pid " + std::to_string(::getpid()))));
  EXPECT_FALSE(heartbeat.lost()) << "the first one has not been harmed";
}

TEST_F(Claim, AKilledWriterIsReplacedAndItsReadersAreTold) {
  leave_a_corpse();
  auto reader = SegmentReader::attach({.name = name_});
  ASSERT_TRUE(reader) << reader.error().message;
  const Nanoseconds start = monotonic_now();
  auto successor = SegmentWriter::create(options_);
  ASSERT_TRUE(successor) << successor.error().message;
  EXPECT_LT(monotonic_now() - start, 500 * kMillisecond) << "a proven death needs no second of watching";
  EXPECT_EQ(reader->life(monotonic_now()), Life::replaced);
  auto again = SegmentReader::attach({.name = name_});
  ASSERT_TRUE(again);
  EXPECT_EQ(again->identity().session_id, successor->session_id());
}

TEST_F(Claim, TheLinesOfADeadWriterStayReadable) {
  leave_a_corpse();
  auto reader = SegmentReader::attach({.name = name_});
  LineCursor cursor;
  LineBatch batch;
  ASSERT_EQ(reader->read_lines(cursor, batch), ReadOutcome::ok);
  expect_points(batch.points_of(batch.lines[0]), 1, 10);
}

/// The pid in the segment is alive, but it is another process (here: ourselves): only the heartbeat can tell.
TEST_F(Claim, AReusedPidDoesNotKeepTheNameForEver) {
  leave_a_corpse();
  auto bytes = RawObject::bytes_of(name_);
  header_of(bytes).writer_pid = static_cast<std::uint32_t>(::getpid());
  RawObject(name_).set(bytes);
  RawObject corpse(name_);
  corpse.set(bytes);
  EXPECT_TRUE(SegmentWriter::create(options_)) << "the start time differs: another process";
  header_of(bytes).writer_start_ticks = this_process().start_ticks;
  corpse.set(bytes);
  EXPECT_TRUE(SegmentWriter::create(options_)) << "nothing differs, but the heart does not beat";
}

/// A pid of another pid namespace says nothing: a living writer there must not be taken for dead.
TEST_F(Claim, APidOfAnotherNamespaceProvesNothing) {
  ProcessIdentity other = this_process();
  other.pid = 4'000'000;
  EXPECT_TRUE(provably_ended(other));
  other.pid_namespace += 1;
  EXPECT_FALSE(provably_ended(other));
}

TEST(ProcessIdentityTest, OneselfIsAliveAndAReapedChildIsNot) {
  EXPECT_FALSE(provably_ended(this_process()));
  ProcessIdentity reused = this_process();
  reused.start_ticks += 1;
  EXPECT_TRUE(provably_ended(reused));
  reused.start_ticks = 0;
  EXPECT_FALSE(provably_ended(reused)) << "without a start time there is no proof";
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  ProcessIdentity zombie = this_process();
  zombie.pid = static_cast<std::uint32_t>(child);
  siginfo_t info{};
  ::waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOWAIT);
  EXPECT_TRUE(provably_ended(zombie)) << "ended, though nobody has waited for it yet";
  ::waitpid(child, nullptr, 0);
  EXPECT_TRUE(provably_ended(zombie));
}

TEST_F(Claim, AnAbandonedStartIsCleared) {
  RawObject object(name_);
  object.set({});
  EXPECT_TRUE(SegmentWriter::create(options_)) << "died before the first byte";
  object.set(std::vector<std::byte>(8192));
  EXPECT_TRUE(SegmentWriter::create(options_)) << "died before the magic";
}

TEST_F(Claim, WhatIsNoSegmentIsLeftAlone) {
  RawObject object(name_);
  std::vector<std::byte> bytes(8192, std::byte{'x'});
  object.set(bytes);
  auto made = SegmentWriter::create(options_);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::mismatch);
  EXPECT_THAT(made.error().message, HasSubstr("no linescope segment"));
  EXPECT_EQ(RawObject::bytes_of(name_), bytes);
  object.set(std::vector<std::byte>(10, std::byte{'x'}));
  made = SegmentWriter::create(options_);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::mismatch) << "too short for a header, and not empty";
}

TEST_F(Claim, SomebodyElsesSegmentIsExplained) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can give an object to somebody else";
  leave_a_corpse();
  ASSERT_EQ(::chown(("/dev/shm/" + name_).c_str(), 65534, 65534), 0);
  const auto made = SegmentWriter::create(options_);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::permission);
  EXPECT_THAT(made.error().message, AllOf(HasSubstr("belongs to nobody"), HasSubstr("--segment")));
  EXPECT_TRUE(exists(name_));
}

TEST_F(Claim, WithoutRoomTheNeededSizeIsNamedAndNothingIsLeft) {
  SegmentOptions huge = options_;
  huge.point_capacity = 4'000'000'000;
  struct statvfs space {};
  ASSERT_EQ(::statvfs("/dev/shm", &space), 0);
  if (space.f_bavail * space.f_frsize > segment_bytes(huge)) GTEST_SKIP() << "more than 80 GB are free here";
  const auto made = SegmentWriter::create(huge);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::full);
  EXPECT_THAT(made.error().message, AllOf(HasSubstr("needs 762"), HasSubstr("MiB free")));
  EXPECT_FALSE(exists(name_));
  EXPECT_FALSE(exists(control_name(name_)));
}

TEST_F(Claim, EveryPageIsReserved) {
  auto writer = SegmentWriter::create(options_);
  struct stat s {};
  ASSERT_EQ(::stat(("/dev/shm/" + name_).c_str(), &s), 0);
  EXPECT_GE(static_cast<std::size_t>(s.st_blocks) * 512, segment_bytes(options_));
  EXPECT_EQ(static_cast<std::size_t>(s.st_size), segment_bytes(options_));
}

TEST_F(Claim, NobodyElseMayReadUnlessAGroupIsNamed) {
  struct stat s {};
  {
    auto writer = SegmentWriter::create(options_);
    ASSERT_EQ(::stat(("/dev/shm/" + name_).c_str(), &s), 0);
    EXPECT_EQ(s.st_mode & 0777U, 0600U);
    ASSERT_EQ(::stat(("/dev/shm/" + control_name(name_)).c_str(), &s), 0);
    EXPECT_EQ(s.st_mode & 0777U, 0600U);
  }
  if (::geteuid() != 0) GTEST_SKIP() << "only root is sure to be allowed to give a file to group nogroup";
  SegmentOptions shared = options_;
  shared.group = "nogroup";
  auto writer = SegmentWriter::create(shared);
  ASSERT_TRUE(writer) << writer.error().message;
  ASSERT_EQ(::stat(("/dev/shm/" + name_).c_str(), &s), 0);
  EXPECT_EQ(s.st_mode & 0777U, 0640U);
  EXPECT_EQ(s.st_gid, 65534U);
}

TEST_F(Claim, AGroupThatDoesNotExistIsRefused) {
  SegmentOptions shared = options_;
  shared.group = "no-such-group-here";
  const auto made = SegmentWriter::create(shared);
  ASSERT_FALSE(made);
  EXPECT_THAT(made.error().message, HasSubstr("no-such-group-here"));
  EXPECT_FALSE(exists(name_));
}

TEST(SegmentOptionsTest, EachFaultIsNamed) {
  SegmentOptions o;
  EXPECT_TRUE(validate(o));
  for (const char* name : {"", "a/b", "../x", ".hidden", "white space"}) {
    o.name = name;
    EXPECT_FALSE(validate(o)) << name;
  }
  o = {};
  o.picture_slots = 2;
  EXPECT_THAT(validate(o).error().message, HasSubstr("picture_slots is 2"));
  o = {};
  o.point_capacity = 1;
  EXPECT_THAT(validate(o).error().message, HasSubstr("point_capacity"));
}

TEST(SegmentOptionsTest, TheDefaultFitsIntoTheSharedMemoryOfAContainer) {
  EXPECT_LT(segment_bytes({}), 64U << 20U) << "64 MiB is what containers get when nobody asks for more";
}

}  // namespace
}  // namespace linescope::testing
