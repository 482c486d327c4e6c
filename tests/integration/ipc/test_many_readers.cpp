// 32 readers, half of them never reading, one mapping nothing but the header. What they cost in time is
// measured by bench_ipc_readers; here: that they cost no line, and that the writer never waits for anybody.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <atomic>
#include <fstream>

#include "ipc/heartbeat.hpp"
#include "ipc/segment_reader.hpp"
#include "ipc/segment_writer.hpp"
#include "tests/integration/ipc/child.hpp"
#include "tests/integration/ipc/kill_series.hpp"

namespace linescope::testing {
namespace {

constexpr std::uint64_t kLines = 4'000;

/// What the reading processes found.
struct Findings {
  std::atomic<std::uint64_t> attached, lines, wrong;
};

class ManyReaders : public ::testing::Test {
 protected:
  ManyReaders()
      : findings_(new (::mmap(nullptr, sizeof(Findings), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS,
                              -1, 0)) Findings{}) {
    SegmentOptions options;
    options.name = name_;
    options.point_capacity = 60'000;
    options.line_capacity = 150;
    auto made = SegmentWriter::create(options);
    if (!made) throw std::runtime_error(made.error().message);
    writer_ = std::make_unique<SegmentWriter>(std::move(*made));
    writer_->set_scanning(true);
  }
  ~ManyReaders() override {
    readers_.clear();
    ::munmap(findings_, sizeof(Findings));
  }

  void start(int count, const std::function<void()>& body) {
    for (int i = 0; i < count; ++i) readers_.push_back(Child::fork(body));
  }

  void attach_and_sleep() const {
    auto reader = SegmentReader::attach({.name = name_});
    findings_->attached += reader ? 1 : 0;
    while (true) ::pause();
  }
  void map_the_header() const {
    const int fd = ::shm_open(name_.c_str(), O_RDONLY, 0);
    findings_->attached += ::mmap(nullptr, 4096, PROT_READ, MAP_SHARED, fd, 0) != MAP_FAILED ? 1 : 0;
    while (true) ::pause();
  }
  void read_for_ever() const {
    auto reader = SegmentReader::attach({.name = name_});
    if (!reader) return;
    ++findings_->attached;
    LineCursor cursor;
    LineBatch batch;
    while (true) {
      if (reader->read_lines(cursor, batch) == ReadOutcome::corrupt) ++findings_->wrong;
      for (const Line& line : batch.lines)
        ++(is_made_up(line, batch.points_of(line)) ? findings_->lines : findings_->wrong);
      findings_->wrong += batch.damaged;
      reader->wait(Topic::lines, 5 * kMillisecond);
    }
  }

  const std::string name_ = "linescope-many-" + std::to_string(::getpid());
  Findings* findings_;
  std::unique_ptr<SegmentWriter> writer_;
  std::vector<Child> readers_;
};

/// Times this thread gave up its processor by itself: it waited for something.
long waits() {
  rusage usage{};
  ::getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_nvcsw;
}

TEST_F(ManyReaders, CostNoLineAndNeverMakeTheWriterWait) {
  start(15, [this] { attach_and_sleep(); });
  start(1, [this] { map_the_header(); });
  start(16, [this] { read_for_ever(); });
  ASSERT_TRUE(within(20 * kSecond, [&] { return findings_->attached == 32; }));
  std::vector<SurfacePoint> points;
  long waited = 0;
  for (std::uint64_t serial = 0; serial < kLines; ++serial) {
    if (writer_->lines_in_scan() == 150) writer_->begin_scan(0);
    make_up(serial, points);
    const ScanLineInfo info = made_up_info(serial, 0);
    const long before = waits();
    writer_->publish_line(info, points);
    waited += waits() - before;
    if (serial % 50 == 0) sleep_us(2'000);  // lets the readers have a look
  }
  EXPECT_EQ(waited, 0);
  EXPECT_EQ(writer_->counted(Counter::lines_published), kLines);
  EXPECT_TRUE(within(20 * kSecond, [&] { return findings_->lines > 0; }));
  EXPECT_EQ(findings_->wrong, 0U);
  for (Child& reader : readers_) EXPECT_EQ(::waitpid(reader.pid(), nullptr, WNOHANG), 0) << "a reader ended";
}

/// Rights of the mappings of this process that lead to the segment.
std::vector<std::string> mappings_of(const std::string& name) {
  std::vector<std::string> rights;
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    if (line.ends_with("/dev/shm/" + name)) rights.push_back(line.substr(line.find(' ') + 1, 4));
  }
  return rights;
}

TEST_F(ManyReaders, MapReadOnly) {
  const std::size_t before = mappings_of(name_).size();
  EXPECT_EQ(before, 1U) << "the writer's own";
  auto reader = SegmentReader::attach({.name = name_});
  ASSERT_TRUE(reader);
  const std::vector<std::string> after = mappings_of(name_);
  ASSERT_EQ(after.size(), 2U);
  EXPECT_EQ(std::count(after.begin(), after.end(), "r--s"), 1);
}

}  // namespace
}  // namespace linescope::testing
