// What readers cost the writer: publishing alone, and with 32 readers attached, in turn. 15 of them never
// read, one maps nothing but the header, 16 read everything at the rate of a display. Target: no more than 5
// % between the two.
//
// Lines come a thousand times per second, thirty times what a camera gives. Processor time of the publishing
// thread.
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/wait.h>

#include <csignal>
#include <thread>

#include "ipc/heartbeat.hpp"
#include "ipc/segment_reader.hpp"
#include "tests/bench/ipc/made_up_scan.hpp"
#include "tests/bench/paired.hpp"

namespace linescope::bench {
namespace {

constexpr int kRounds = 15;
constexpr int kLinesPerRound = 400;

[[noreturn]] void attach_and_sleep(const std::string& name) {
  auto reader = SegmentReader::attach({.name = name});
  while (true) ::pause();
}

[[noreturn]] void map_the_header(const std::string& name) {
  const int fd = ::shm_open(name.c_str(), O_RDONLY, 0);
  ::mmap(nullptr, sizeof(ls_header), PROT_READ, MAP_SHARED, fd, 0);
  while (true) ::pause();
}

[[noreturn]] void read_at_display_rate(const std::string& name) {
  auto reader = SegmentReader::attach({.name = name});
  LineCursor cursor;
  LineBatch batch;
  while (true) {
    if (reader) reader->read_lines(cursor, batch);
    std::this_thread::sleep_for(std::chrono::milliseconds(16));
  }
}

[[noreturn]] void sleep_for_lines(const std::string& name) {
  auto reader = SegmentReader::attach({.name = name});
  while (true) {
    if (reader) reader->wait(Topic::lines, kSecond);
  }
}

class Readers {
 public:
  template <class Body>
  void start(int count, const std::string& name, const Body& body) {
    for (int i = 0; i < count; ++i) {
      const pid_t child = ::fork();
      if (child == 0) body(name);
      children_.push_back(child);
    }
  }
  ~Readers() {
    for (const pid_t child : children_) ::kill(child, SIGKILL);
    for (const pid_t child : children_) ::waitpid(child, nullptr, 0);
  }

 private:
  std::vector<pid_t> children_;
};

/// Median processor time of one publish call, ns.
double cost_of_a_line(SegmentWriter& writer, const std::vector<SurfacePoint>& points) {
  std::vector<double> costs;
  for (int i = 0; i < kLinesPerRound; ++i) {
    if (writer.lines_in_scan() == kLinesPerScan) writer.begin_scan(0);
    const Nanoseconds start = processor_now();
    writer.publish_line({}, points);
    costs.push_back(static_cast<double>(processor_now() - start));
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return median(costs);
}

void readers_cost(benchmark::State& state) {
  const bool asleep = state.range(0) == 1;
  auto writer = SegmentWriter::create(scan_options("readers"));
  if (!writer) return state.SkipWithError(writer.error().message.c_str());
  const Heartbeat heartbeat(*writer);
  writer->set_scanning(true);
  const std::vector<SurfacePoint> points = one_line();
  std::vector<double> alone, crowded, quotients;
  for (auto _ : state) {
    for (int round = 0; round < kRounds; ++round) {
      alone.push_back(cost_of_a_line(*writer, points));
      Readers readers;
      readers.start(15, writer->name(), attach_and_sleep);
      readers.start(1, writer->name(), map_the_header);
      readers.start(16, writer->name(), asleep ? sleep_for_lines : read_at_display_rate);
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
      crowded.push_back(cost_of_a_line(*writer, points));
      quotients.push_back(crowded.back() / alone.back());
    }
  }
  state.counters["alone_ns"] = median(alone);
  state.counters["with_32_readers_ns"] = median(crowded);
  state.counters["ratio"] = median(quotients);
}
BENCHMARK(readers_cost)
    ->Arg(0)
    ->Name("readers_at_display_rate")
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(readers_cost)
    ->Arg(1)
    ->Name("readers_asleep_for_lines")
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace linescope::bench

BENCHMARK_MAIN();
