// The real linescope-acquire as a child process, and what can be read from its segment.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ipc/segment_reader.hpp"
#include "tests/support/child_process.hpp"

namespace linescope::testing {

/// Starts the daemon on a segment of its own.
class DaemonUnderTest {
 public:
  explicit DaemonUnderTest(std::vector<std::string> arguments, std::string segment = unique_segment());

  /// Kills it and removes what a killed daemon leaves in /dev/shm.
  ~DaemonUnderTest();
  DaemonUnderTest(const DaemonUnderTest&) = delete;
  DaemonUnderTest& operator=(const DaemonUnderTest&) = delete;

  ChildProcess& process() { return process_; }
  const std::string& segment() const { return segment_; }

  /// Attached once the daemon is up; nothing when it ended first or did not come in time.
  std::optional<SegmentReader> attach();

 private:
  std::string segment_;
  ChildProcess process_;
};

/// Runs to its end: exit code and what it said.
struct Outcome {
  int exit_code = -1;
  std::string said;
};
Outcome run_daemon_to_end(std::vector<std::string> arguments);

/// Everything of the current scan.
LineBatch whole_scan(const SegmentReader& reader);

std::uint64_t counter(const SegmentReader& reader, Counter which);

}  // namespace linescope::testing
