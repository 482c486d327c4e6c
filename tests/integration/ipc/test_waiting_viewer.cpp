// What the viewer's acquisition thread does with a segment that is none, not readable or not ours: one
// sentence, nothing followed, and it keeps waiting for a good one.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <functional>

#include "tests/support/child_process.hpp"
#include "tests/unit/ipc/raw_object.hpp"
#include "tests/unit/viewer/fake_daemon.hpp"
#include "viewer/segment_feed.hpp"

namespace linescope::testing {
namespace {

using namespace std::chrono_literals;
using Bytes = std::vector<std::byte>;

struct BadSegment {
  const char* what;
  std::function<void(Bytes&)> damage;
  const char* sentence;  ///< part of what the operator reads
  unsigned mode = 0600;
  bool foreign = false;
};

const std::vector<BadSegment>& bad_segments() {
  static const std::vector<BadSegment> all{
      {"AnotherLayoutVersion", [](Bytes& b) { header_of(b).layout_major = 9; }, "has layout version 9."},
      {"LongerThanItsHeaderSays", [](Bytes& b) { b.resize(b.size() + 4096); }, "but its header says"},
      {"Truncated", [](Bytes& b) { b.resize(b.size() / 2); }, "truncated"},
      {"ShorterThanAHeader", [](Bytes& b) { b.resize(100); }, "truncated"},
      {"OfSomebodyElse", [](Bytes&) {}, "belongs to", 0600, true},
      {"OfModeZero", [](Bytes&) {}, "may not be opened by", 0},
      {"NotOursAtAll", [](Bytes& b) { b.assign(5'000, std::byte{'x'}); }, "is no linescope segment"},
  };
  return all;
}

/// A feed with the newest it said.
class Viewer {
 public:
  explicit Viewer(const std::string& segment)
      : feed_(FeedOptions{.segment = segment},
              FeedSinks{.live = [this](std::shared_ptr<const LiveView> v) { live_.put(std::move(v)); },
                        .lines = [](const LineNews&) {}}) {}
  bool says(LinkState state, const std::string& sentence) {
    return eventually(
        [&] {
          const auto view = live_.get();
          return view->link.state == state && view->link.text.find(sentence) != std::string::npos;
        },
        10s);
  }
  std::string text() { return live_.get()->link.text; }

 private:
  Latest<LiveView> live_;
  SegmentFeed feed_;
};

Bytes good_bytes() {
  const std::string name = unique_segment();
  const FakeDaemon daemon(name);
  return RawObject::bytes_of(name);
}

/// Empty, or what went wrong.
std::string waits_for_a_good_one(const BadSegment& bad, const std::string& name) {
  Bytes bytes = good_bytes();
  bad.damage(bytes);
  auto object = std::make_unique<RawObject>(name);
  object->set(bytes, bad.mode);
  if (bad.foreign && ::chown(("/dev/shm/" + name).c_str(), 65534, 65534) != 0) return "chown";
  Viewer viewer(name);
  if (!viewer.says(LinkState::refused, bad.sentence)) return "it said: " + viewer.text();
  if (!viewer.says(LinkState::refused, name)) return "it does not say which: " + viewer.text();
  object.reset();
  if (!viewer.says(LinkState::searching, "no linescope daemon")) return "gone; it said: " + viewer.text();
  const FakeDaemon daemon(name);
  return viewer.says(LinkState::attached, "") ? "" : "good one; it said: " + viewer.text();
}

class WaitingViewer : public ::testing::TestWithParam<BadSegment> {
 protected:
  void TearDown() override { remove_leftovers(name_); }
  const std::string name_ = unique_segment();
};

TEST_P(WaitingViewer, SaysItInASentenceAndTakesTheNextGoodOne) {
  const BadSegment& bad = GetParam();
  const bool root = ::geteuid() == 0;
  if (bad.foreign && !root) GTEST_SKIP() << "only root can give an object to somebody else";
  if (bad.mode != 0 || !root) {
    EXPECT_EQ(waits_for_a_good_one(bad, name_), "");
    return;
  }
  // Root may open everything: look with other eyes.
  const pid_t child = ::fork();
  if (child == 0) {
    const bool other = ::setgid(65534) == 0 && ::setuid(65534) == 0;
    const std::string wrong = other ? waits_for_a_good_one(bad, name_) : "setuid";
    std::fputs(wrong.c_str(), stderr);
    ::_exit(wrong.empty() ? 0 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
}
INSTANTIATE_TEST_SUITE_P(Bad, WaitingViewer, ::testing::ValuesIn(bad_segments()),
                         [](const auto& bad) { return std::string(bad.param.what); });

class ReplacedSegment : public WaitingViewer {};

TEST_F(ReplacedSegment, IsToldAndTheGoodOneThatFollowsIsTaken) {
  auto first = std::make_unique<FakeDaemon>(name_);
  Viewer viewer(name_);
  ASSERT_TRUE(viewer.says(LinkState::attached, ""));
  const Bytes nonsense(5'000, std::byte{'x'});
  auto intruder = std::make_unique<RawObject>(name_);
  intruder->set(nonsense);  // another object under the name that is mapped
  ASSERT_TRUE(viewer.says(LinkState::refused, "is no linescope segment")) << viewer.text();
  EXPECT_EQ(RawObject::bytes_of(name_), nonsense) << "what is not ours is left alone";
  first.reset();
  intruder.reset();
  const FakeDaemon second(name_);
  EXPECT_TRUE(viewer.says(LinkState::attached, "")) << viewer.text();
}

}  // namespace
}  // namespace linescope::testing
