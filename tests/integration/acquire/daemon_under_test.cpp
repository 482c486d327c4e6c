#include "tests/integration/acquire/daemon_under_test.hpp"

#include <csignal>

namespace linescope::testing {
namespace {

std::vector<std::string> command(std::vector<std::string> arguments, const std::string& segment) {
  arguments.insert(arguments.begin(), LINESCOPE_ACQUIRE);
  arguments.insert(arguments.end(), {"--segment", segment});
  return arguments;
}

}  // namespace

DaemonUnderTest::DaemonUnderTest(std::vector<std::string> arguments, std::string segment)
    : segment_(std::move(segment)), process_(command(std::move(arguments), segment_)) {}

DaemonUnderTest::~DaemonUnderTest() {
  if (process_.running()) process_.send(SIGKILL);
  process_.wait(std::chrono::seconds(10));
  remove_leftovers(segment_);
}

std::optional<SegmentReader> DaemonUnderTest::attach() {
  std::optional<SegmentReader> reader;
  eventually([&] {
    auto attached = SegmentReader::attach({.name = segment_});
    if (attached) reader.emplace(std::move(*attached));
    return reader.has_value() || !process_.running();
  });
  return reader;
}

Outcome run_daemon_to_end(std::vector<std::string> arguments) {
  DaemonUnderTest daemon(std::move(arguments));
  const auto end = daemon.process().wait(std::chrono::seconds(30));
  return {end && !end->signalled ? end->code : -1, daemon.process().standard_error()};
}

LineBatch whole_scan(const SegmentReader& reader) {
  LineCursor cursor;
  LineBatch batch;
  reader.read_lines(cursor, batch, 100'000'000);
  return batch;
}

std::uint64_t counter(const SegmentReader& reader, Counter which) {
  for (const CounterValue& value : reader.counters())
    if (value.name == name(which)) return value.value;
  return 0;
}

}  // namespace linescope::testing
