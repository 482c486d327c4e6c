// Publishing a line of 640 points with its poses, beside copying the same bytes and beside what others do.
//
// Targets (docs/performance-ipc.md): at most 1.3 times memcpy into the mapping, 1.2 times memcpy to private
// memory, and a sixth of a lock per point. iceoryx, which needs a subscriber for a fair comparison, is in
// bench_handoff.
#include <sys/mman.h>

#include <boost/interprocess/allocators/allocator.hpp>
#include <boost/interprocess/containers/vector.hpp>
#include <boost/interprocess/managed_shared_memory.hpp>
#include <boost/interprocess/sync/interprocess_mutex.hpp>
#include <boost/interprocess/sync/scoped_lock.hpp>
#include <cstring>

#include "tests/bench/ipc/made_up_scan.hpp"
#include "tests/bench/paired.hpp"

namespace linescope::bench {
namespace {

namespace bip = boost::interprocess;

constexpr int kLinesPerRound = 147;  ///< the thesis's scan
constexpr int kRounds = 101;

/// Room for a whole scan of lines, filled one after the other and then from the start again: private, or a
/// shared mapping.
class PlainRoom {
 public:
  explicit PlainRoom(bool shared)
      : bytes_(static_cast<std::byte*>(
            ::mmap(nullptr, kLinesPerScan * kLineBytes, PROT_READ | PROT_WRITE,
                   (shared ? MAP_SHARED : MAP_PRIVATE) | MAP_ANONYMOUS | MAP_POPULATE, -1, 0))) {}
  ~PlainRoom() { ::munmap(bytes_, kLinesPerScan * kLineBytes); }
  PlainRoom(const PlainRoom&) = delete;
  PlainRoom& operator=(const PlainRoom&) = delete;

  void copy(const void* line) {
    std::memcpy(bytes_ + next_ * kLineBytes, line, kLineBytes);
    benchmark::ClobberMemory();
    next_ = (next_ + 1) % kLinesPerScan;
  }

 private:
  std::byte* bytes_;
  std::size_t next_ = 0;
};

/// The usual way with Boost: a shared vector of points, and its mutex taken for each.
class LockPerPoint {
  using Points =
      bip::vector<SurfacePoint, bip::allocator<SurfacePoint, bip::managed_shared_memory::segment_manager>>;

 public:
  LockPerPoint() : memory_(bip::create_only, name_.c_str(), (64U << 20U)) {
    mutex_ = memory_.construct<bip::interprocess_mutex>("mutex")();
    points_ = memory_.construct<Points>("points")(memory_.get_segment_manager());
    points_->reserve(kLinesPerScan * kPointsPerLine);
  }
  ~LockPerPoint() { bip::shared_memory_object::remove(name_.c_str()); }
  LockPerPoint(const LockPerPoint&) = delete;
  LockPerPoint& operator=(const LockPerPoint&) = delete;

  void add(const std::vector<SurfacePoint>& line) {
    if (points_->size() + line.size() > kLinesPerScan * kPointsPerLine) points_->clear();
    for (const SurfacePoint& point : line) {
      const bip::scoped_lock lock(*mutex_);
      points_->push_back(point);
    }
  }

 private:
  std::string name_ = "linescope-bench-boost-" + std::to_string(::getpid());
  bip::managed_shared_memory memory_;
  bip::interprocess_mutex* mutex_ = nullptr;
  Points* points_ = nullptr;
};

void publish_line(benchmark::State& state) {
  auto writer = SegmentWriter::create(scan_options("publish"));
  if (!writer) return state.SkipWithError(writer.error().message.c_str());
  writer->set_scanning(true);
  const std::vector<SurfacePoint> points = one_line();
  std::vector<std::byte> plain(kLineBytes);
  std::memcpy(plain.data(), points.data(), points.size() * sizeof(SurfacePoint));
  PlainRoom private_room(false), shared_room(true);
  LockPerPoint boost;
  const auto each = [](const auto& line) {
    return [&line] {
      for (int i = 0; i < kLinesPerRound; ++i) line();
    };
  };
  const auto copy_private = [&] { private_room.copy(plain.data()); };
  const auto copy_shared = [&] { shared_room.copy(plain.data()); };
  const auto publish = [&] {
    if (writer->lines_in_scan() == kLinesPerScan) writer->begin_scan(0);
    benchmark::DoNotOptimize(writer->publish_line({}, points));
  };
  const auto lock_per_point = [&] { boost.add(points); };
  std::vector<Way> ways{{"memcpy_private", each(copy_private), {}},
                        {"memcpy_mapping", each(copy_shared), {}},
                        {"publish", each(publish), {}},
                        {"lock_per_point", each(lock_per_point), {}}};
  for (auto _ : state) run_in_turn(ways, kRounds);
  report(state, ways, kLinesPerRound);
  state.counters["x_memcpy_private"] = ratio(ways[2], ways[0]);
  state.counters["x_memcpy_mapping"] = ratio(ways[2], ways[1]);
  state.counters["lock_per_point_x_publish"] = ratio(ways[3], ways[2]);
}
BENCHMARK(publish_line)->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace linescope::bench

BENCHMARK_MAIN();
