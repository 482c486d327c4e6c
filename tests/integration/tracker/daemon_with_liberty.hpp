// The unmodified linescope-acquire as a child process on a scripted LIBERTY, judged by what readers of its
// segment see. Counts only: deadlines are there to end a broken run.
#pragma once

#include <gtest/gtest.h>

#include <csignal>
#include <string>
#include <vector>

#include "tests/integration/acquire/daemon_under_test.hpp"
#include "tests/integration/tracker/fake/fake_liberty.hpp"

namespace linescope::testing {

class DaemonWithLiberty {
 public:
  /// `more`: options on top of "no camera, tracker liberty".
  explicit DaemonWithLiberty(FakeLiberty& unit, const std::vector<std::string>& more = {})
      : unit_(unit), daemon_(arguments(more)), reader_(daemon_.attach()) {}

  /// Patient ones: the unit's clock is this process, and while a busy machine holds it up the unit is silent.
  static std::vector<std::string> arguments(const std::vector<std::string>& more) {
    std::vector<std::string> all{"--camera",      "none",
                                 "--tracker",     "liberty",
                                 "--calibration", "thesis-camera-ii",
                                 "--set",         "liberty.silence_limit_ms=60000",
                                 "--set",         "liberty.answer_timeout_ms=10000"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  bool up() const { return reader_.has_value(); }
  std::string said() { return daemon_.process().standard_error(); }
  const SegmentReader& reader() const { return *reader_; }

  std::uint64_t count(Counter which) const { return counter(*reader_, which); }
  std::uint64_t published() const { return count(Counter::tracker_samples_published); }

  template <class Condition>
  static bool until(Condition condition) {
    return eventually(condition, std::chrono::seconds(60));
  }
  bool until_count(Counter which, std::uint64_t value) const {
    return until([&] { return count(which) >= value; });
  }

  /// The unit measures `cycles` times, `burst` at once, and waits each time until all samples of `sensors`
  /// sensors are in the segment.
  bool measure(int cycles, int sensors, int burst = 4) {
    for (int done = 0; done < cycles; done += burst) {
      const int now = std::min(burst, cycles - done);
      const std::uint64_t wanted = published() + static_cast<std::uint64_t>(now * sensors);
      unit_.run_cycles(now);
      if (!promptly([&] { return published() >= wanted; })) return false;
    }
    return true;
  }
  /// Goes on measuring until `condition` holds.
  template <class Condition>
  bool measure_until(Condition condition) {
    return until([&] {
      if (unit_.packets_waiting() == 0) unit_.run_cycles(1);
      return condition();
    });
  }

  SensorStatus sensor(int station) const {
    SensorStatus status;
    reader_->sensor_status(station, status);
    return status;
  }
  DaemonStatus state() const {
    DaemonStatus status;
    reader_->status(status);
    return status;
  }

  /// SIGTERM, and the exit code; -1: killed or stuck.
  int end() {
    daemon_.process().send(SIGTERM);
    const auto end = daemon_.process().wait(std::chrono::seconds(20));
    return end && !end->signalled ? end->code : -1;
  }

 private:
  /// eventually() with short naps: this is asked thousands of times.
  template <class Condition>
  static bool promptly(Condition condition) {
    for (int i = 0; i < 300'000; ++i) {
      if (condition()) return true;
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
    return false;
  }

  FakeLiberty& unit_;
  DaemonUnderTest daemon_;
  std::optional<SegmentReader> reader_;
};

}  // namespace linescope::testing
