// kill -9 at random instants, of the writer, of readers and of command senders.
//
// The check kills a few dozen times. The long run: LINESCOPE_KILLS=1000 bin/test_ipc_crash (results in
// docs/segment.md).
#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "ipc/control.hpp"
#include "tests/integration/ipc/child.hpp"
#include "tests/integration/ipc/kill_series.hpp"
#include "tests/support/child_process.hpp"

namespace linescope::testing {
namespace {

class Crash : public ::testing::Test {
 protected:
  Child start_publisher(const std::string& rate = "0") const {
    return Child::program({LINESCOPE_IPC_PUBLISHER, name_, rate}, log_);
  }
  bool exists(const std::string& name) const { return ::access(("/dev/shm/" + name).c_str(), F_OK) == 0; }
  int random(int most) { return std::uniform_int_distribution(0, most)(random_); }
  void TearDown() override {
    remove_leftovers(name_);
    ::unlink(log_.c_str());
  }
  std::string log() const {
    std::ifstream in(log_);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  const std::string name_ = "linescope-crash-" + std::to_string(::getpid());
  const std::string log_ = ::testing::TempDir() + name_ + ".log";
  std::mt19937 random_{20240611};
};

TEST_F(Crash, AWriterKilledAtAnyInstantHurtsNobody) {
  KillSeries series(name_, is_made_up);
  for (int i = 0; i < kills(25); ++i) {
    Child publisher = start_publisher();
    // Most kills hit a publisher at full speed, some one that is just being born or taking over.
    const bool newborn = i % 8 == 7;
    if (!newborn) {
      ASSERT_TRUE(within(10 * kSecond, [&] { return series.alive(); })) << "round " << i << "\n" << log();
    }
    series.kill(newborn ? 20'000 : 40'000, [&] { publisher.kill(); });
    ASSERT_FALSE(HasFatalFailure());
  }
  series.expect_unharmed();
}

[[noreturn]] void read_for_ever(const std::string& name) {
  while (true) {
    auto reader = SegmentReader::attach({.name = name});
    LineCursor cursor;
    LineBatch batch;
    Picture picture;
    while (reader && reader->life(monotonic_now()) == Life::live) {
      reader->read_lines(cursor, batch);
      reader->picture(picture);
      reader->wait(Topic::lines | Topic::pictures, 5 * kMillisecond);
    }
  }
}

[[noreturn]] void send_for_ever(const std::string& name) {
  while (true) {
    auto reader = SegmentReader::attach({.name = name});
    auto client = reader ? ControlClient::open(*reader) : Result<ControlClient>(fail(ErrorCode::gone, ""));
    while (client) {
      const auto id = client->send({CommandKind::exposure, 1.5, "made-up"});
      if (id) client->await(*id, 20 * kMillisecond);
    }
  }
}

TEST_F(Crash, KilledReadersAndSendersCostTheWriterNothing) {
  Child publisher = start_publisher();
  ASSERT_TRUE(within(10 * kSecond, [&] { return SegmentReader::attach({.name = name_}).has_value(); }))
      << log();
  Watcher watcher(name_);
  for (int i = 0; i < kills(40); ++i) {
    Child victim = Child::fork([&] { i % 2 == 0 ? read_for_ever(name_) : send_for_ever(name_); });
    sleep_us(random(15'000));
    victim.kill();
  }
  auto reader = SegmentReader::attach({.name = name_});
  ASSERT_TRUE(reader);
  auto client = ControlClient::open(*reader);
  ASSERT_TRUE(client);
  ASSERT_TRUE(within(5 * kSecond, [&] {
    const auto id = client->send({CommandKind::laser_brightness, 0.5, {}});
    return id && client->await(*id, kSecond).value_or(CommandAnswer{}).kind == AnswerKind::refused;
  })) << "a command of a living sender still gets its own answer";
  EXPECT_TRUE(client->send({CommandKind::shut_down, 0, {}}));
  const int status = publisher.wait();
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << log();
  unsigned long long offered = 0, published = 1;
  ASSERT_EQ(std::sscanf(log().c_str(), "offered %llu published %llu", &offered, &published), 2) << log();
  EXPECT_EQ(offered, published);
  EXPECT_GT(offered, static_cast<unsigned long long>(kills(40)));
  const WatcherAccount& account = watcher.finish();
  EXPECT_EQ(account.torn + account.damaged + account.repeated + account.unexplained + account.corrupt, 0U);
  std::printf("kills %d, lines offered %llu, published %llu\n", kills(40), offered, published);
}

TEST_F(Crash, TermAndIntLeaveNothingBehind) {
  for (const int signal : {SIGTERM, SIGINT}) {
    Child publisher = start_publisher("30");
    ASSERT_TRUE(within(10 * kSecond, [&] { return SegmentReader::attach({.name = name_}).has_value(); }))
        << log();
    auto reader = SegmentReader::attach({.name = name_});
    publisher.signal(signal);
    const int status = publisher.wait();
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    EXPECT_FALSE(exists(name_));
    EXPECT_FALSE(exists(name_ + "-control"));
    EXPECT_EQ(reader->life(monotonic_now()), Life::closed);
  }
}

TEST_F(Crash, ASecondWriterIsRefusedWithThePidOfTheFirst) {
  Child first = start_publisher("30");
  ASSERT_TRUE(within(10 * kSecond, [&] { return SegmentReader::attach({.name = name_}).has_value(); }))
      << log();
  const std::string second_log = log_ + "2";
  Child second = Child::program({LINESCOPE_IPC_PUBLISHER, name_, "30"}, second_log);
  const int status = second.wait();
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 1);
  std::ifstream in(second_log);
  const std::string said(std::istreambuf_iterator<char>(in), {});
  EXPECT_NE(said.find("already running"), std::string::npos) << said;
  EXPECT_NE(said.find("pid " + std::to_string(first.pid())), std::string::npos) << said;
  ::unlink(second_log.c_str());
}

TEST_F(Crash, OfSeveralStartersOfADeadNameExactlyOneWins) {
  {
    Child corpse = start_publisher("30");
    ASSERT_TRUE(within(10 * kSecond, [&] { return SegmentReader::attach({.name = name_}).has_value(); }))
        << log();
  }
  ASSERT_TRUE(exists(name_));
  std::vector<Child> starters;
  for (int i = 0; i < 4; ++i) starters.push_back(Child::program({LINESCOPE_IPC_PUBLISHER, name_, "30"}));
  sleep_us(2'500'000);  // more than anybody watches a doubtful heartbeat
  auto reader = SegmentReader::attach({.name = name_});
  ASSERT_TRUE(reader);
  EXPECT_TRUE(within(10 * kSecond, [&] { return reader->life(monotonic_now()) == Life::live; }));
  int winners = 0, refused = 0;
  for (Child& starter : starters) {
    const bool has_it = reader->identity().writer_pid == static_cast<std::uint32_t>(starter.pid());
    if (has_it) starter.signal(SIGTERM);
    const int status = starter.wait();
    winners += has_it && WIFEXITED(status) && WEXITSTATUS(status) == 0;
    refused += !has_it && WIFEXITED(status) && WEXITSTATUS(status) == 1;
  }
  EXPECT_EQ(winners, 1);
  EXPECT_EQ(refused, 3);
}

/// Stopped for so long that a successor took the name: it must not go on as if nothing had happened, nor
/// remove the name.
TEST_F(Crash, AWriterThatWasStoppedAndReplacedDoesNotDisturbItsSuccessor) {
  Child stopped = start_publisher("30");
  ASSERT_TRUE(within(10 * kSecond, [&] { return SegmentReader::attach({.name = name_}).has_value(); }))
      << log();
  auto old_reader = SegmentReader::attach({.name = name_});
  stopped.signal(SIGSTOP);
  Child successor = start_publisher("30");
  ASSERT_TRUE(within(10 * kSecond, [&] { return old_reader->life(monotonic_now()) == Life::replaced; }));
  stopped.signal(SIGCONT);
  stopped.signal(SIGTERM);
  stopped.wait();
  EXPECT_TRUE(exists(name_));
  ASSERT_TRUE(within(10 * kSecond, [&] {
    auto reader = SegmentReader::attach({.name = name_});
    return reader && reader->life(monotonic_now()) == Life::live &&
           reader->identity().writer_pid == static_cast<std::uint32_t>(successor.pid());
  }));
  successor.signal(SIGTERM);
  successor.wait();
}

}  // namespace
}  // namespace linescope::testing
