// Handing a line of 640 points to a reader in another process: until the reader knows of it, and what it
// costs the writer.
//
// Message by message in turn: the segment; a bare futex between two bare processes that hands over nothing at
// all; the same with the line's bytes copied by memcpy (into as much memory as a scan takes); iceoryx where
// it is installed. `asleep`: a message every 4 ms, the reader sleeps in between. `polling`: back to back, the
// reader spins. Targets: asleep at most 1.2 times the bare futex; polling half, asleep 1/1.4 of iceoryx;
// writer's side 1/1.8 of iceoryx. Times on the wall: the quieter the machine the better.
#include <sched.h>
#include <sys/mman.h>
#include <sys/wait.h>

#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>

#include "ipc/futex.hpp"
#include "ipc/heartbeat.hpp"
#include "ipc/segment_reader.hpp"
#include "tests/bench/ipc/iceoryx_peer.hpp"
#include "tests/bench/ipc/made_up_scan.hpp"
#include "tests/bench/paired.hpp"

namespace linescope::bench {
namespace {

constexpr int kMost = 20'000;
enum Mechanism { kSegment, kFutex, kFutexCopy, kIceoryx, kMechanisms };

struct Bell {
  alignas(64) std::uint32_t word;
  alignas(64) std::uint32_t sleeps;
};

/// Between the two processes: the bare futexes, acknowledgements, and the moments at which the reader saw
/// each message.
struct Board {
  std::atomic<std::uint32_t> sender_ready, reader_ready;
  alignas(64) std::atomic<std::uint32_t> acknowledged;
  Bell bare, with_bytes;
  alignas(64) std::byte frames[kLinesPerScan][kLineBytes];
  alignas(64) std::array<Nanoseconds, kMost> seen[kMechanisms];
  std::array<double, kMost> handoff[kMechanisms];      ///< ns
  std::array<double, kMost> writer_side[kMechanisms];  ///< ns
};

void pin(unsigned cpu) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(cpu % std::max(1U, std::thread::hardware_concurrency()), &set);
  ::sched_setaffinity(0, sizeof set, &set);
}

/// The bare minimum: a word in shared memory, woken only when somebody sleeps.
struct BareFutex {
  Bell& bell;
  void signal() const {
    __atomic_fetch_add(&bell.word, 1U, __ATOMIC_SEQ_CST);
    if (__atomic_load_n(&bell.sleeps, __ATOMIC_SEQ_CST) != 0) shared::futex_wake(bell.word, shared::kAllBits);
  }
  void await(std::uint32_t number, bool blocking) const {
    while (true) {
      const std::uint32_t now = __atomic_load_n(&bell.word, __ATOMIC_SEQ_CST);
      if (now == number) return;
      if (!blocking) continue;
      __atomic_store_n(&bell.sleeps, 1U, __ATOMIC_SEQ_CST);
      shared::futex_wait(bell.word, now, monotonic_now() + kSecond, shared::kAllBits);
      __atomic_store_n(&bell.sleeps, 0U, __ATOMIC_SEQ_CST);
    }
  }
};

std::array<std::pair<Mechanism, Bell*>, 2> bells(Board& board) {
  return {{{kFutex, &board.bare}, {kFutexCopy, &board.with_bytes}}};
}

struct Run {
  Board& board;
  std::string segment;
  int messages;
  bool blocking;
  bool iceoryx;
};

void await_line(SegmentReader& reader, LineCursor& cursor, LineBatch& batch, bool blocking,
                Nanoseconds& seen) {
  while (true) {
    const bool news = blocking ? reader.wait(Topic::lines, kSecond) : reader.news(Topic::lines);
    if (!news) continue;
    seen = monotonic_now();
    if (reader.read_lines(cursor, batch) == ReadOutcome::ok && !batch.lines.empty()) return;
  }
}

[[noreturn]] void read_all(const Run& run) {
  pin(1);
  while (run.board.sender_ready == 0) std::this_thread::yield();
  auto reader = SegmentReader::attach({.name = run.segment});
  if (!reader) std::_Exit(1);
  const auto subscriber = run.iceoryx ? IceoryxSubscriber::create() : nullptr;
  LineCursor cursor;
  LineBatch batch;
  IceoryxFrame frame{};
  reader->read_lines(cursor, batch);
  reader->news(Topic::all);
  run.board.reader_ready = 1;
  for (int i = 0; i < run.messages; ++i) {
    const auto at = static_cast<std::size_t>(i);
    await_line(*reader, cursor, batch, run.blocking, run.board.seen[kSegment][at]);
    ++run.board.acknowledged;
    for (const auto& [mechanism, bell] : bells(run.board)) {
      BareFutex{*bell}.await(static_cast<std::uint32_t>(i) + 1, run.blocking);
      run.board.seen[mechanism][at] = monotonic_now();
      ++run.board.acknowledged;
    }
    if (!subscriber) continue;
    run.board.seen[kIceoryx][at] = subscriber->take(run.blocking, frame);
    ++run.board.acknowledged;
  }
  std::_Exit(0);
}

class Sender {
 public:
  Sender(const Run& run, SegmentWriter& writer, IceoryxPublisher* iceoryx)
      : run_(run), writer_(writer), iceoryx_(iceoryx) {}

  void send_all() {
    pin(0);
    touch_everything();
    run_.board.sender_ready = 1;
    while (run_.board.reader_ready == 0) std::this_thread::yield();
    for (int i = 0; i < run_.messages; ++i) {
      send(kSegment, i, [&] { writer_.publish_line({}, points_); });
      send(kFutex, i, [&] { BareFutex{run_.board.bare}.signal(); });
      send(kFutexCopy, i, [&] {
        std::memcpy(run_.board.frames[static_cast<std::size_t>(i) % kLinesPerScan], points_.data(),
                    points_.size() * sizeof(SurfacePoint));
        BareFutex{run_.board.with_bytes}.signal();
      });
      if (iceoryx_ != nullptr) send(kIceoryx, i, [&] { iceoryx_->publish(points_.data()); });
    }
  }

 private:
  /// A fork maps shared pages anew: none of the ways shall pay for that in the run.
  void touch_everything() {
    std::memset(run_.board.frames, 1, sizeof run_.board.frames);
    for (std::size_t i = 0; i < kLinesPerScan; ++i) writer_.publish_line({}, points_);
    writer_.begin_scan(0);
  }

  template <class Publish>
  void send(Mechanism mechanism, int i, const Publish& publish) {
    if (writer_.lines_in_scan() == kLinesPerScan) writer_.begin_scan(0);
    if (run_.blocking) std::this_thread::sleep_for(std::chrono::milliseconds(4));
    const Nanoseconds start = monotonic_now();
    publish();
    const auto at = static_cast<std::size_t>(i);
    run_.board.writer_side[mechanism][at] = static_cast<double>(monotonic_now() - start);
    ++sent_;
    while (run_.board.acknowledged != sent_) std::this_thread::yield();
    run_.board.handoff[mechanism][at] = static_cast<double>(run_.board.seen[mechanism][at] - start);
  }

  const Run& run_;
  SegmentWriter& writer_;
  IceoryxPublisher* iceoryx_;
  std::vector<SurfacePoint> points_ = one_line();
  std::uint32_t sent_ = 0;
};

/// iceoryx keeps its connection per process: so writer and reader are both children, made anew for each
/// benchmark.
[[noreturn]] void send_all(const Run& run, SegmentWriter& writer) {
  const Heartbeat heartbeat(writer);
  const auto iceoryx = run.iceoryx ? IceoryxPublisher::create() : nullptr;
  Sender(run, writer, iceoryx.get()).send_all();
  std::_Exit(0);
}

struct Figures {
  std::vector<double> handoff, writer_side;
};

void report(benchmark::State& state, const Run& run) {
  const char* names[] = {"segment", "futex", "futex_copy", "iceoryx"};
  std::vector<Figures> all;
  for (int m = 0; m < (run.iceoryx ? kMechanisms : kIceoryx); ++m) {
    const double* handoff = run.board.handoff[m].data();
    const double* writer_side = run.board.writer_side[m].data();
    all.push_back({{handoff, handoff + run.messages}, {writer_side, writer_side + run.messages}});
    state.counters[std::string(names[m]) + "_p50_us"] = quantile(all.back().handoff, 0.5) * 1e-3;
    state.counters[std::string(names[m]) + "_p99_us"] = quantile(all.back().handoff, 0.99) * 1e-3;
    state.counters[std::string(names[m]) + "_writer_us"] = median(all.back().writer_side) * 1e-3;
  }
  const auto times = [&](Mechanism other, double share) {
    return quantile(all[kSegment].handoff, share) / quantile(all[other].handoff, share);
  };
  state.counters["x_futex_p50"] = times(kFutex, 0.5);
  state.counters["x_futex_p99"] = times(kFutex, 0.99);
  state.counters["x_futex_copy_p50"] = times(kFutexCopy, 0.5);
  state.counters["x_futex_copy_p99"] = times(kFutexCopy, 0.99);
  if (!run.iceoryx) return;
  state.counters["iceoryx_x_segment"] = median(all[kIceoryx].handoff) / median(all[kSegment].handoff);
  state.counters["iceoryx_x_segment_writer"] =
      median(all[kIceoryx].writer_side) / median(all[kSegment].writer_side);
}

void hand_off(benchmark::State& state) {
  static const IceoryxDaemon roudi;
  const bool blocking = state.range(0) == 1;
  void* memory = ::mmap(nullptr, sizeof(Board), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  auto* board = new (memory) Board;
  auto writer = SegmentWriter::create(scan_options(blocking ? "asleep" : "polling"));
  if (!writer) return state.SkipWithError(writer.error().message.c_str());
  writer->set_scanning(true);
  const Run run{*board, writer->name(), blocking ? 1'500 : kMost, blocking, roudi.running()};
  for (auto _ : state) {
    const pid_t reader = ::fork();
    if (reader == 0) read_all(run);
    const pid_t sender = ::fork();
    if (sender == 0) send_all(run, *writer);
    ::waitpid(reader, nullptr, 0);
    ::waitpid(sender, nullptr, 0);
  }
  report(state, run);
  ::munmap(memory, sizeof(Board));
}
BENCHMARK(hand_off)->Arg(0)->Name("hand_off_polling")->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK(hand_off)->Arg(1)->Name("hand_off_asleep")->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace linescope::bench

BENCHMARK_MAIN();
