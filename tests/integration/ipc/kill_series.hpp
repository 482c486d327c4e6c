// A series of kills at random instants: how many, when, and how soon each was noticed.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <thread>
#include <vector>

#include "tests/integration/ipc/watcher.hpp"

namespace linescope::testing {

/// The check kills a few dozen times, LINESCOPE_KILLS=1000 a thousand times (results in docs/segment.md).
inline int kills(int in_the_check) {
  const char* wanted = std::getenv("LINESCOPE_KILLS");
  return wanted != nullptr ? std::atoi(wanted) : in_the_check;
}

inline void sleep_us(int us) {
  std::this_thread::sleep_for(std::chrono::microseconds(us));
}

template <class Condition>
bool within(Nanoseconds time, const Condition& condition) {
  for (const Nanoseconds end = monotonic_now() + time; monotonic_now() < end; sleep_us(500)) {
    if (condition()) return true;
  }
  return condition();
}

class KillSeries {
 public:
  /// `whole` as for the watcher that follows all writers of the segment.
  KillSeries(const std::string& segment, LineCheck whole) : watcher_(segment, whole) {}

  bool alive() const { return watcher_.alive() != 0; }
  bool lines_come() const { return watcher_.lines_of_this_writer() > 0; }

  /// Kills (with `kill`, which waits for the end) a writer that the watcher may be following.
  template <class Kill>
  void kill(int most_us, const Kill& kill) {
    sleep_us(std::uniform_int_distribution(0, most_us)(random_));
    const bool was_alive = alive();
    const Nanoseconds killed = monotonic_now();
    kill();
    const Nanoseconds dead = monotonic_now();
    ++kills_;
    if (!was_alive) return;
    ASSERT_TRUE(within(10 * kSecond, [&] { return !alive(); })) << "kill " << kills_;
    noticed_after_.push_back(watcher_.noticed() - killed);
    EXPECT_LE(watcher_.last_alive() - dead, kDeadAfter)
        << "a look later than that still found it alive; kill " << kills_;
  }

  /// Nothing torn, nothing repeated, nothing unexplained, every death noticed.
  void expect_unharmed() {
    const WatcherAccount& account = watcher_.finish();
    EXPECT_EQ(account.torn, 0U);
    EXPECT_EQ(account.damaged, 0U);
    EXPECT_EQ(account.repeated, 0U);
    EXPECT_EQ(account.unexplained, 0U);
    EXPECT_EQ(account.corrupt, 0U);
    EXPECT_GE(account.sessions, noticed_after_.size());
    EXPECT_GE(account.lines, noticed_after_.size());
    ASSERT_FALSE(noticed_after_.empty());
    std::sort(noticed_after_.begin(), noticed_after_.end());
    // The last one is up to the machine, which may keep the reader from looking; the middle one is not.
    EXPECT_LE(middle(), 200 * kMillisecond) << "death is noticed within 0.2 s";
    print(account);
  }

 private:
  Nanoseconds middle() const { return noticed_after_[noticed_after_.size() / 2]; }

  void print(const WatcherAccount& account) const {
    const auto in_time = std::upper_bound(noticed_after_.begin(), noticed_after_.end(), 200 * kMillisecond) -
                         noticed_after_.begin();
    std::printf(
        "kills %d, sessions %llu, lines checked %llu, torn %llu, repeated %llu; death noticed after: median "
        "%.0f ms, largest %.0f ms, within 200 ms %td of %zu\n",
        kills_, static_cast<unsigned long long>(account.sessions),
        static_cast<unsigned long long>(account.lines),
        static_cast<unsigned long long>(account.torn + account.damaged),
        static_cast<unsigned long long>(account.repeated), milliseconds_from(middle()),
        milliseconds_from(noticed_after_.back()), in_time, noticed_after_.size());
  }

  Watcher watcher_;
  std::vector<Nanoseconds> noticed_after_;
  std::mt19937 random_{20240611};
  int kills_ = 0;
};

}  // namespace linescope::testing
