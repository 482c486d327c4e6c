// Copying a million points out of a segment, beside memcpy of the same bytes out of a mapping of it. Target:
// at most 1.2 times.
#include <fcntl.h>
#include <sys/mman.h>

#include <cstring>

#include "ipc/segment_reader.hpp"
#include "tests/bench/ipc/made_up_scan.hpp"
#include "tests/bench/paired.hpp"

namespace linescope::bench {
namespace {

constexpr std::size_t kLines = 1'563;  ///< 1,000,320 points
constexpr std::size_t kBytes = kLines * kPointsPerLine * sizeof(SurfacePoint);
constexpr int kRounds = 41;

/// The points of a segment as one piece of memory.
class PointsMapping {
 public:
  explicit PointsMapping(const std::string& name) {
    const int fd = ::shm_open(name.c_str(), O_RDONLY, 0);
    size_ = static_cast<std::size_t>(::lseek(fd, 0, SEEK_END));
    bytes_ =
        static_cast<const std::byte*>(::mmap(nullptr, size_, PROT_READ, MAP_SHARED | MAP_POPULATE, fd, 0));
    ::close(fd);
  }
  ~PointsMapping() { ::munmap(const_cast<std::byte*>(bytes_), size_); }
  PointsMapping(const PointsMapping&) = delete;
  PointsMapping& operator=(const PointsMapping&) = delete;

  const std::byte* points() const {
    const auto& header = *reinterpret_cast<const ls_header*>(bytes_);
    for (const ls_section& section : header.sections) {
      if (section.kind == LS_SECTION_POINTS) return bytes_ + section.offset;
    }
    return nullptr;
  }

 private:
  std::size_t size_ = 0;
  const std::byte* bytes_ = nullptr;
};

void read_a_million_points(benchmark::State& state) {
  const SegmentOptions options = scan_options("read", kLines);
  auto writer = SegmentWriter::create(options);
  if (!writer) return state.SkipWithError(writer.error().message.c_str());
  writer->set_scanning(true);
  const std::vector<SurfacePoint> points = one_line();
  for (std::size_t i = 0; i < kLines; ++i) writer->publish_line({}, points);
  auto reader = SegmentReader::attach({.name = options.name});
  if (!reader) return state.SkipWithError(reader.error().message.c_str());
  const PointsMapping mapping(options.name);
  std::vector<std::byte> plain(kBytes);
  LineBatch batch;
  bool whole = true;
  std::vector<Way> ways{
      {"memcpy", [&] { benchmark::DoNotOptimize(std::memcpy(plain.data(), mapping.points(), kBytes)); }, {}},
      {"read_lines",
       [&] {
         LineCursor cursor;
         reader->read_lines(cursor, batch, 2 * kLines * kPointsPerLine);
         whole = whole && batch.lines.size() == kLines && batch.damaged == 0;
       },
       {}}};
  for (auto _ : state) run_in_turn(ways, kRounds);
  if (!whole) return state.SkipWithError("not all lines were read");
  report(state, ways, 1);
  state.counters["x_memcpy"] = ratio(ways[1], ways[0]);
}
BENCHMARK(read_a_million_points)->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace linescope::bench

BENCHMARK_MAIN();
