// The mailbox: an answer for every command, and nothing lost by whoever dies half way.
#include <gmock/gmock.h>

#include <set>
#include <thread>

#include "ipc/control.hpp"
#include "ipc/control_slot.hpp"
#include "ipc/segment_writer.hpp"
#include "tests/unit/ipc/raw_object.hpp"
#include "tests/unit/ipc/segment_fixture.hpp"

namespace linescope::testing {
namespace {

using ::testing::HasSubstr;

class Control : public SegmentTest {
 protected:
  void SetUp() override {
    SegmentTest::SetUp();
    server_ = std::make_unique<ControlServer>(*writer_);
    client_ = std::make_unique<ControlClient>(client());
    const int fd = ::shm_open(control_name(name_).c_str(), O_RDWR, 0);
    raw_ = static_cast<ls_control*>(
        ::mmap(nullptr, sizeof(ls_control), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0));
    ::close(fd);
  }
  void TearDown() override { ::munmap(raw_, sizeof(ls_control)); }

  ControlClient client() const {
    auto opened = ControlClient::open(*reader_);
    if (!opened) throw std::runtime_error(opened.error().message);
    return std::move(*opened);
  }
  CommandId send(CommandKind kind, double number = 0, std::string text = "") {
    auto id = client_->send({kind, number, std::move(text)});
    EXPECT_TRUE(id) << id.error().message;
    return id ? *id : 0;
  }
  int poll(CommandAnswer answer = {}, Nanoseconds now = monotonic_now()) {
    return server_->poll(now, [&](const ReceivedCommand& c) {
      seen_.push_back(c);
      return answer;
    });
  }

  std::unique_ptr<ControlServer> server_;
  std::unique_ptr<ControlClient> client_;
  std::vector<ReceivedCommand> seen_;
  ls_control* raw_ = nullptr;
};

TEST_F(Control, ACommandArrivesWholeAndIsAnswered) {
  const CommandId id = send(CommandKind::save, 2.5, "/tmp/scan.ply");
  EXPECT_EQ(client_->answer(id).kind, AnswerKind::pending);
  EXPECT_EQ(poll({AnswerKind::refused, "the disk is full"}), 1);
  ASSERT_EQ(seen_.size(), 1U);
  EXPECT_EQ(seen_[0].kind, CommandKind::save);
  EXPECT_EQ(seen_[0].number, 2.5);
  EXPECT_EQ(seen_[0].text, "/tmp/scan.ply");
  EXPECT_EQ(seen_[0].id, id);
  EXPECT_EQ(seen_[0].sender_pid, static_cast<std::uint32_t>(::getpid()));
  const CommandAnswer answer = client_->answer(id);
  EXPECT_EQ(answer.kind, AnswerKind::refused);
  EXPECT_EQ(answer.text, "the disk is full");
  EXPECT_EQ(client_->answer(id).kind, AnswerKind::lost) << "an answer is given once";
}

TEST_F(Control, EveryKindIsCarriedOut) {
  for (std::uint32_t kind = LS_COMMAND_START; kind <= LS_COMMAND_SHUT_DOWN; ++kind) {
    const CommandId id = send(static_cast<CommandKind>(kind));
    poll();
    EXPECT_EQ(client_->answer(id).kind, AnswerKind::done);
    EXPECT_EQ(static_cast<std::uint32_t>(seen_.back().kind), kind);
  }
  EXPECT_EQ(writer_->counted(Counter::commands_done), static_cast<std::uint64_t>(LS_COMMAND_SHUT_DOWN));
}

TEST_F(Control, OneThatIsNotKnownIsAnsweredSo) {
  const CommandId id = send(static_cast<CommandKind>(77));
  poll();
  EXPECT_TRUE(seen_.empty());
  EXPECT_EQ(client_->answer(id).kind, AnswerKind::unknown);
  EXPECT_EQ(writer_->counted(Counter::commands_unknown), 1U);
}

TEST_F(Control, TheOrderIsThatOfSending) {
  ControlClient other = client();
  for (int i = 0; i < 20; ++i) (i % 2 == 0 ? *client_ : other).send({CommandKind::exposure, 1.0 * i, {}});
  poll();
  ASSERT_EQ(seen_.size(), 20U);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(seen_[static_cast<std::size_t>(i)].number, i);
}

TEST_F(Control, ACommandMayBeAnsweredLater) {
  const CommandId id = send(CommandKind::save);
  poll({AnswerKind::pending, {}});
  poll({}, monotonic_now() + 60 * kSecond);
  EXPECT_EQ(client_->answer(id).kind, AnswerKind::pending);
  server_->answer(id, {AnswerKind::done, "saved"});
  EXPECT_EQ(client_->answer(id).text, "saved");
}

TEST_F(Control, ALateAnswerToNothingChangesNothing) {
  server_->answer(0, {});
  server_->answer(12345, {});
  EXPECT_EQ(writer_->counted(Counter::commands_done), 0U);
}

TEST_F(Control, WaitingForAnAnswerEndsInTime) {
  const CommandId id = send(CommandKind::stop);
  const auto answer = client_->await(id, 30 * kMillisecond);
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::timeout);
}

TEST_F(Control, BothEndsSleepUntilTheOtherHasActed) {
  std::thread daemon([&] {
    EXPECT_TRUE(server_->wait(60 * kSecond));
    poll({AnswerKind::done, "started"});
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  const auto answer = client_->await(send(CommandKind::start), 60 * kSecond);
  daemon.join();
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->text, "started");
  EXPECT_FALSE(server_->wait(kMillisecond));
}

TEST_F(Control, BadArgumentsAreRefusedBeforeSending) {
  EXPECT_EQ(client_->send({CommandKind::save, 0, std::string(88, 'x')}).error().code, ErrorCode::usage);
  EXPECT_EQ(client_->send({CommandKind::exposure, std::nan(""), {}}).error().code, ErrorCode::invalid);
  EXPECT_TRUE(client_->send({CommandKind::save, 0, std::string(87, 'x')}));
}

TEST_F(Control, WhenNobodyAnswersTheMailboxGetsFullAndSaysSo) {
  for (int i = 0; i < LS_CONTROL_SLOTS; ++i) send(CommandKind::stop);
  const auto one_more = client_->send({CommandKind::stop, 0, {}});
  ASSERT_FALSE(one_more);
  EXPECT_EQ(one_more.error().code, ErrorCode::full);
  EXPECT_EQ(poll(), LS_CONTROL_SLOTS);
}

TEST_F(Control, AnswersNobodyFetchesAreThrownAway) {
  for (int i = 0; i < LS_CONTROL_SLOTS; ++i) send(CommandKind::stop);
  const Nanoseconds now = monotonic_now();
  poll({}, now);
  poll({}, now + kMillisecond);
  poll({}, now + 11 * kSecond);
  EXPECT_EQ(writer_->counted(Counter::answers_not_collected), static_cast<std::uint64_t>(LS_CONTROL_SLOTS));
  EXPECT_NE(send(CommandKind::start), 0U);
}

/// A sender that was killed between claiming a slot and completing its request.
TEST_F(Control, ASlotWhoseSenderDiedIsFreedAndCounted) {
  for (int i = 0; i < LS_CONTROL_SLOTS; ++i) {
    raw_->slots[i].word = slot_word(static_cast<std::uint64_t>(1000 + i), LS_SLOT_CLAIMED);
  }
  EXPECT_FALSE(client_->send({CommandKind::stop, 0, {}}));
  const Nanoseconds now = monotonic_now();
  poll({}, now);
  EXPECT_FALSE(client_->send({CommandKind::stop, 0, {}})) << "a slow sender is given time";
  poll({}, now + 1001 * kMillisecond);
  EXPECT_EQ(writer_->counted(Counter::commands_sender_died), static_cast<std::uint64_t>(LS_CONTROL_SLOTS));
  const CommandId id = send(CommandKind::stop);
  poll({}, now + 1002 * kMillisecond);
  EXPECT_EQ(client_->answer(id).kind, AnswerKind::done);
}

/// A sender that was stopped so long that its slot was given to another one, and then wrote into it.
TEST_F(Control, ARequestOverwrittenByALatecomerIsRefused) {
  const CommandId id = send(CommandKind::exposure, 3);
  raw_->slots[slot_of(id)].request.number = 300;
  poll();
  EXPECT_TRUE(seen_.empty()) << "the laser must not do what nobody asked for";
  const CommandAnswer answer = client_->answer(id);
  EXPECT_EQ(answer.kind, AnswerKind::refused);
  EXPECT_THAT(answer.text, HasSubstr("damaged"));
  EXPECT_EQ(writer_->counted(Counter::commands_damaged), 1U);
}

TEST_F(Control, GarbageInTheMailboxCostsNobodyAnything) {
  std::uint32_t random = 1;
  for (int round = 0; round < 200; ++round) {
    for (ls_slot& slot : raw_->slots) {
      auto* bytes = reinterpret_cast<unsigned char*>(&slot);
      for (std::size_t i = 0; i < sizeof slot; ++i)
        bytes[i] = static_cast<unsigned char>((random = random * 1664525U + 1013904223U) >> 24U);
    }
    poll({}, round * kSecond);
  }
  for (int round = 200; round < 230; ++round) poll({}, round * kSecond);
  EXPECT_TRUE(seen_.empty());
  const CommandId id = send(CommandKind::start);
  poll({}, 300 * kSecond);
  EXPECT_EQ(client_->answer(id).kind, AnswerKind::done) << "all slots are free again";
}

TEST_F(Control, ManySendersAtOnceGetAnAnswerEach) {
  constexpr int kSenders = 4, kEach = 200;
  std::atomic<int> done{0}, finished{0};
  std::vector<std::thread> senders;
  for (int s = 0; s < kSenders; ++s) {
    senders.emplace_back([&] {
      ControlClient mine = client();
      for (int i = 0; i < kEach; ++i) {
        const auto id = mine.send({CommandKind::exposure, 1.0 * i, {}});
        if (id && mine.await(*id, 60 * kSecond).value_or(CommandAnswer{AnswerKind::lost, {}}).kind ==
                      AnswerKind::done)
          ++done;
      }
      ++finished;
    });
  }
  while (finished < kSenders) {
    if (server_->wait(kMillisecond)) poll();
  }
  for (std::thread& sender : senders) sender.join();
  EXPECT_EQ(done, kSenders * kEach);
  std::set<CommandId> ids;
  for (const ReceivedCommand& c : seen_) ids.insert(c.id);
  EXPECT_EQ(ids.size(), static_cast<std::size_t>(kSenders * kEach)) << "each exactly once";
}

TEST_F(Control, TheMailboxOfASuccessorIsNotMistaken) {
  const CommandId id = send(CommandKind::start);
  SegmentReader old = attach();
  server_.reset();
  open(small_segment(name_));
  const auto opened = ControlClient::open(old);
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ErrorCode::gone);
  const auto answer = client_->await(id, 10 * kMillisecond);
  EXPECT_FALSE(answer) << "nobody answers any more";
}

}  // namespace
}  // namespace linescope::testing
