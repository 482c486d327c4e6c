#include <gtest/gtest.h>
#include <signal.h>

#include <utility>

#include "ipc/control.hpp"
#include "tests/integration/acquire/daemon_under_test.hpp"

namespace linescope::testing {
namespace {

using namespace std::chrono_literals;

CommandAnswer ask(const SegmentReader& reader, CommandKind kind, double number = 0, std::string text = {}) {
  const Command command{kind, number, std::move(text)};
  auto client = ControlClient::open(reader);
  if (!client) return {AnswerKind::lost, client.error().message};
  auto id = client->send(command);
  if (!id) return {AnswerKind::lost, id.error().message};
  auto answer = client->await(*id, 5 * kSecond);
  return answer ? *answer : CommandAnswer{AnswerKind::lost, answer.error().message};
}

TEST(LifeCycle, EndsInGoodOrderOnEachSignalAndLeavesNothingBehind) {
  for (int signal : {SIGTERM, SIGINT, SIGHUP}) {
    DaemonUnderTest daemon({"--scan"});
    ASSERT_TRUE(daemon.attach()) << daemon.process().standard_error();
    EXPECT_FALSE(leftovers(daemon.segment()).empty());
    daemon.process().send(signal);
    const auto end = daemon.process().wait(10s);
    ASSERT_TRUE(end);
    EXPECT_FALSE(end->signalled);
    EXPECT_EQ(end->code, 0) << daemon.process().standard_error();
    EXPECT_TRUE(leftovers(daemon.segment()).empty());
  }
}

TEST(LifeCycle, ASecondDaemonIsRefusedWithThePidOfTheFirst) {
  DaemonUnderTest first({"--scan", "--set", "twin.scenario=sweeps"});
  auto reader = first.attach();
  ASSERT_TRUE(reader) << first.process().standard_error();
  ASSERT_TRUE(eventually([&] { return counter(*reader, Counter::lines_published) > 0; }));
  DaemonUnderTest second({}, first.segment());
  const auto end = second.process().wait(10s);
  ASSERT_TRUE(end);
  EXPECT_EQ(end->code, 7);
  const std::string said = second.process().standard_error();
  EXPECT_NE(said.find("already running"), std::string::npos) << said;
  EXPECT_NE(said.find("pid " + std::to_string(first.process().pid())), std::string::npos) << said;
  EXPECT_TRUE(first.process().running());
  // What the first one has scanned is untouched, and it goes on.
  const std::uint64_t lines = counter(*reader, Counter::lines_published);
  EXPECT_GT(lines, 0u);
  EXPECT_TRUE(eventually([&] { return counter(*reader, Counter::lines_published) > lines; }));
  EXPECT_GE(whole_scan(*reader).lines.size(), lines);
}

TEST(LifeCycle, AKilledDaemonIsNoticedAndReplaced) {
  DaemonUnderTest first({"--scan"});
  auto reader = first.attach();
  ASSERT_TRUE(reader) << first.process().standard_error();
  first.process().send(SIGKILL);
  ASSERT_TRUE(first.process().wait(10s));
  EXPECT_TRUE(eventually([&] { return reader->life(monotonic_now()) != Life::live; }, 2s));
  DaemonUnderTest second({"--scan"}, first.segment());
  EXPECT_TRUE(eventually([&] { return reader->life(monotonic_now()) == Life::replaced; }))
      << second.process().standard_error();
  auto again = second.attach();
  ASSERT_TRUE(again) << second.process().standard_error();
  EXPECT_NE(again->identity().session_id, reader->identity().session_id);
  EXPECT_TRUE(eventually([&] { return counter(*again, Counter::lines_published) > 0; }));
}

TEST(LifeCycle, CommandsStartStopClearAndUndo) {
  DaemonUnderTest daemon({"--set", "twin.scenario=sweeps", "--fast"});
  auto reader = daemon.attach();
  ASSERT_TRUE(reader) << daemon.process().standard_error();
  ASSERT_TRUE(eventually([&] { return counter(*reader, Counter::frames_not_scanning) > 5; }));
  EXPECT_EQ(counter(*reader, Counter::lines_published), 0u);

  EXPECT_EQ(ask(*reader, CommandKind::start).kind, AnswerKind::done);
  ASSERT_TRUE(eventually([&] { return whole_scan(*reader).lines.size() > 20; }));
  EXPECT_EQ(ask(*reader, CommandKind::stop).kind, AnswerKind::done);
  const std::size_t first_sweep = whole_scan(*reader).lines.size();
  EXPECT_EQ(ask(*reader, CommandKind::start).kind, AnswerKind::done);
  ASSERT_TRUE(eventually([&] { return whole_scan(*reader).lines.size() > first_sweep + 20; }));
  EXPECT_EQ(ask(*reader, CommandKind::stop).kind, AnswerKind::done);
  EXPECT_EQ(ask(*reader, CommandKind::undo_sweep).kind, AnswerKind::done);
  EXPECT_EQ(whole_scan(*reader).lines.size(), first_sweep);
  EXPECT_EQ(ask(*reader, CommandKind::undo_sweep).kind, AnswerKind::done);
  EXPECT_EQ(whole_scan(*reader).lines.size(), 0u);
  const CommandAnswer nothing_left = ask(*reader, CommandKind::undo_sweep);
  EXPECT_EQ(nothing_left.kind, AnswerKind::refused);
  EXPECT_NE(nothing_left.text.find("no sweep"), std::string::npos);
}

TEST(LifeCycle, SaveWritesAScanThatAnIndependentReaderCounts) {
  TemporaryFolder folder;
  const auto file = folder.path() / "scan.ply";
  DaemonUnderTest daemon({"--set", "twin.scenario=sweeps", "--scan", "--fast"});
  auto reader = daemon.attach();
  ASSERT_TRUE(reader) << daemon.process().standard_error();
  ASSERT_TRUE(eventually([&] { return whole_scan(*reader).lines.size() > 30; }));
  ASSERT_EQ(ask(*reader, CommandKind::stop).kind, AnswerKind::done);
  const CommandAnswer saved = ask(*reader, CommandKind::save, 0, file.string());
  EXPECT_EQ(saved.kind, AnswerKind::done) << saved.text;
  const std::size_t points = whole_scan(*reader).points.size();
  EXPECT_EQ(saved.text, std::to_string(points) + " points saved");
  // 5 floats and a line number per vertex, as the header says.
  EXPECT_EQ(std::filesystem::file_size(file) % 24, (std::filesystem::file_size(file) - points * 24) % 24);
  EXPECT_GT(std::filesystem::file_size(file), points * 24);
  EXPECT_LT(std::filesystem::file_size(file), points * 24 + 1000);

  const CommandAnswer nowhere = ask(*reader, CommandKind::save, 0, "/no/such/folder/scan.ply");
  EXPECT_EQ(nowhere.kind, AnswerKind::refused);
  EXPECT_NE(nowhere.text.find("/no/such/folder"), std::string::npos);
}

TEST(LifeCycle, WhatCannotBeDoneIsRefusedWithAReason) {
  DaemonUnderTest daemon({});
  auto reader = daemon.attach();
  ASSERT_TRUE(reader) << daemon.process().standard_error();
  EXPECT_EQ(ask(*reader, CommandKind::laser_brightness, 0.5).kind, AnswerKind::refused);
  EXPECT_EQ(ask(*reader, CommandKind::exposure, 5).kind, AnswerKind::refused);
  EXPECT_EQ(ask(*reader, CommandKind::shut_down).kind, AnswerKind::done);
  const auto end = daemon.process().wait(10s);
  ASSERT_TRUE(end);
  EXPECT_EQ(end->code, 0);
  EXPECT_TRUE(leftovers(daemon.segment()).empty());
}

TEST(LifeCycle, AFullSegmentIsAStateAndPosesGoOn) {
  // A tenth of a minute is 180 lines; the twin at full speed fills it.
  DaemonUnderTest daemon(
      {"--set", "twin.scenario=sweeps", "--set", "run.capacity_minutes=0.1", "--scan", "--fast"});
  auto reader = daemon.attach();
  ASSERT_TRUE(reader) << daemon.process().standard_error();
  ASSERT_TRUE(eventually([&] { return reader->full(); }, 120s));
  DaemonStatus status;
  EXPECT_TRUE(eventually(
      [&] { return reader->status(status) == ReadOutcome::ok && status.state == DaemonState::full; }));
  EXPECT_FALSE(status.reason.empty());
  const std::uint64_t poses = counter(*reader, Counter::tracker_samples_published);
  EXPECT_TRUE(eventually([&] { return counter(*reader, Counter::tracker_samples_published) > poses + 100; }));
  EXPECT_TRUE(eventually([&] { return counter(*reader, Counter::lines_segment_full) > 0; }));
  EXPECT_EQ(counter(*reader, Counter::lines_offered),
            counter(*reader, Counter::lines_published) + counter(*reader, Counter::lines_segment_full));
}

}  // namespace
}  // namespace linescope::testing
