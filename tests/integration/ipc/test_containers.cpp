// What containers change: a pid that means something else outside, and a /dev/shm that is small. Needs the
// right to make namespaces (root); elsewhere these tests say so and are skipped.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/prctl.h>

#include "ipc/control.hpp"
#include "ipc/process_identity.hpp"
#include "ipc/segment_reader.hpp"
#include "ipc/segment_writer.hpp"
#include "tests/integration/ipc/child.hpp"
#include "tests/integration/ipc/kill_series.hpp"
#include "tests/support/child_process.hpp"

namespace linescope::testing {
namespace {

constexpr int kNotPermitted = 77;
#define LINESCOPE_NEEDS_NAMESPACES(permitted) \
  if (!(permitted)) GTEST_SKIP() << "this user may not make namespaces"

class Containers : public ::testing::Test {
 protected:
  void TearDown() override { remove_leftovers(name_); }
  SegmentOptions options(std::uint32_t points) const {
    SegmentOptions o;
    o.name = name_;
    o.point_capacity = points;
    o.line_capacity = 200;
    o.picture_bytes = 64 * 48 * 3;
    return o;
  }
  const std::string name_ = "linescope-container-" + std::to_string(::getpid());
};

/// The publisher as process 1 of a pid namespace of its own. It dies with the child that is returned.
Child publisher_in_its_own_pid_namespace(const std::string& name) {
  return Child::fork([&] {
    if (::unshare(CLONE_NEWPID) != 0) ::_exit(kNotPermitted);
    const pid_t inside = ::fork();
    if (inside == 0) {
      ::prctl(PR_SET_PDEATHSIG, SIGKILL);
      ::execl(LINESCOPE_IPC_PUBLISHER, LINESCOPE_IPC_PUBLISHER, name.c_str(), "30", nullptr);
      ::_exit(127);
    }
    ::waitpid(inside, nullptr, 0);
  });
}

bool may_make_pid_namespaces() {
  Child probe = Child::fork([] { ::_exit(::unshare(CLONE_NEWPID) == 0 ? 0 : kNotPermitted); });
  return probe.wait() == 0;
}

/// Its pid is 1 in there. Out here process 1 is another one and lives on: only the heartbeat can tell.
TEST_F(Containers, TheHeartbeatDecidesOverAWriterInAnotherPidNamespace) {
  LINESCOPE_NEEDS_NAMESPACES(may_make_pid_namespaces());
  Child container = publisher_in_its_own_pid_namespace(name_);
  ASSERT_TRUE(within(10 * kSecond, [&] { return SegmentReader::attach({.name = name_}).has_value(); }));
  auto reader = SegmentReader::attach({.name = name_});
  EXPECT_EQ(reader->identity().writer_pid, 1U);
  const auto second = SegmentWriter::create(options(1'000));
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, ErrorCode::busy) << second.error().message;
  EXPECT_NE(second.error().message.find("already running"), std::string::npos) << second.error().message;
  container.kill();
  ASSERT_TRUE(within(10 * kSecond, [&] { return reader->life(monotonic_now()) == Life::silent; }));
  const auto successor = SegmentWriter::create(options(1'000));
  ASSERT_TRUE(successor) << successor.error().message;
  EXPECT_EQ(reader->life(monotonic_now()), Life::replaced);
}

bool on_a_small_disk() {
  return ::unshare(CLONE_NEWNS) == 0 && ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
         ::mount("tmpfs", "/dev/shm", "tmpfs", 0, "size=8m") == 0;
}

/// Takes what is left of /dev/shm.
void use_up_the_disk() {
  const int fd = ::open("/dev/shm/everything-else", O_WRONLY | O_CREAT, 0600);
  const std::vector<char> block(4096);
  while (::write(fd, block.data(), block.size()) > 0) {
  }
}

void publish_until_full(SegmentWriter& writer) {
  writer.set_scanning(true);
  std::vector<SurfacePoint> points;
  for (std::uint64_t serial = 0;; ++serial) {
    make_up(serial, points);
    if (writer.publish_line(made_up_info(serial, 0), points) == PublishOutcome::full) break;
  }
  const std::vector<std::byte> pixels(64 * 48 * 3);
  for (int i = 0; i < 8; ++i)
    writer.publish_picture({.width = 64, .height = 48}, pixels.data(), 64 * 3,
                           std::vector<PictureSample>(2'048));
  for (int i = 0; i < 5'000; ++i) {
    PoseSample sample;
    sample.station = static_cast<std::uint8_t>(i % kMaxStations);
    writer.publish_pose(sample);
  }
  writer.publish_configuration(std::string(65'536, 'x'));
}

/// 0, or the step that failed.
int start_and_publish_on_a_small_disk(const SegmentOptions& too_large, const SegmentOptions& fitting) {
  if (!on_a_small_disk()) return kNotPermitted;
  const auto refused = SegmentWriter::create(too_large);
  if (refused || refused.error().code != ErrorCode::full) return 1;
  const std::string& text = refused.error().message;
  if (text.find("needs 2") == std::string::npos || text.find("8.0 MiB free") == std::string::npos) return 2;
  auto writer = SegmentWriter::create(fitting);
  if (!writer) return 3;
  use_up_the_disk();
  publish_until_full(*writer);
  if (writer->counted(Counter::points_published) < 50'000) return 4;
  auto reader = SegmentReader::attach({.name = fitting.name});
  auto client = reader ? ControlClient::open(*reader) : Result<ControlClient>(fail(ErrorCode::gone, ""));
  return client && client->send({CommandKind::stop, 0, {}}) ? 0 : 5;
}

TEST_F(Containers, WithAFullSharedMemoryAWriterStartsNotAtAllOrNeverFails) {
  Child child =
      Child::fork([&] { ::_exit(start_and_publish_on_a_small_disk(options(1'000'000), options(60'000))); });
  const int status = child.wait();
  LINESCOPE_NEEDS_NAMESPACES(!WIFEXITED(status) || WEXITSTATUS(status) != kNotPermitted);
  ASSERT_TRUE(WIFEXITED(status)) << "ended by signal " << WTERMSIG(status);
  EXPECT_EQ(WEXITSTATUS(status), 0) << "number of the step that failed";
}

}  // namespace
}  // namespace linescope::testing
