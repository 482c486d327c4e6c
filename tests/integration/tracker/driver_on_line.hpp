// Runs a LibertySource on a scripted unit and counts what comes out. No wall-clock bounds: deadlines are
// there only to end a broken run.
#pragma once

#include <memory>
#include <vector>

#include "acquire/tracker/liberty/liberty_source.hpp"
#include "tests/integration/tracker/fake/fake_liberty.hpp"

namespace linescope::testing {

/// The unit's clock is this process: while a busy machine holds it up the unit is silent, and that is no
/// fault.
inline LibertyOptions patient_options() {
  LibertyOptions options;
  options.answer_timeout = 10 * kSecond;
  options.silence_limit = 60 * kSecond;
  return options;
}

class DriverOnLine {
 public:
  DriverOnLine(FakeLiberty& unit, const LibertyOptions& options) : unit_(unit), source_(options) {}

  LibertySource& source() { return source_; }
  std::vector<PoseSample>& samples() { return samples_; }

  /// Takes samples until `done()`; `step()` before each look. False when a generous deadline passed.
  template <class Done, class Step>
  bool until(Done done, Step step) {
    const Nanoseconds give_up = monotonic_now() + 60 * kSecond;
    PoseSample sample;
    while (!done()) {
      if (monotonic_now() > give_up) return false;
      step();
      if (const auto pull = source_.next(sample); pull && *pull == Pull::item) samples_.push_back(sample);
    }
    return true;
  }
  template <class Done>
  bool until(Done done) {
    return until(done, [] {});
  }
  bool take(std::size_t count) {
    const std::size_t wanted = samples_.size() + count;
    return until([&] { return samples_.size() >= wanted; });
  }
  /// The unit measures, as fast as its output is fetched, until `done()`.
  template <class Done>
  bool run_until(Done done) {
    return until(done, [this] {
      if (unit_.packets_waiting() == 0) unit_.run_cycles(1);
    });
  }

 private:
  FakeLiberty& unit_;
  LibertySource source_;
  std::vector<PoseSample> samples_;
};

}  // namespace linescope::testing
