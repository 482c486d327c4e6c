#include "tests/fuzz/ipc/mutated_segment.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "ipc/control.hpp"
#include "ipc/segment_reader.hpp"
#include "ipc/segment_writer.hpp"

namespace linescope::testing {
namespace {

SegmentOptions tiny(const std::string& name) {
  SegmentOptions o;
  o.name = name;
  o.point_capacity = 64;
  o.line_capacity = 8;
  o.points_per_line = 32;
  o.pose_history = 4;
  o.picture_slots = 3;
  o.picture_bytes = 16 * 8 * 3;
  o.picture_samples = 4;
  o.frame_history = 4;
  o.text_bytes = 64;
  return o;
}

std::string own_name(const char* what) {
  return "linescope-fuzz-" + std::to_string(::getpid()) + what;
}

void fill(SegmentWriter& writer) {
  writer.publish_configuration("width = 16");
  writer.publish_calibration("%YAML:1.0");
  writer.set_sensor_status(0, {});
  writer.set_camera_status({});
  for (std::uint8_t station = 0; station < kMaxStations; ++station) {
    PoseSample sample;
    sample.station = station;
    for (int i = 0; i < 6; ++i) writer.publish_pose(sample);
  }
  writer.set_scanning(true);
  const std::vector<SurfacePoint> points(9, {{1, 2, 3}, 4, 5});
  for (int i = 0; i < 5; ++i) writer.publish_line({}, points);
  writer.undo_to(3);
  writer.publish_line({}, points);
  const std::vector<std::byte> pixels(16 * 8 * 3);
  const std::vector<PictureSample> samples(2);
  writer.publish_picture({.width = 16, .height = 8}, pixels.data(), 48, samples);
  writer.record_latency(LatencyStage::extract, 1000);
  writer.count(Counter::frames_received);
}

std::vector<std::uint8_t> bytes_of(const std::string& name) {
  const int fd = ::shm_open(name.c_str(), O_RDONLY, 0);
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(::lseek(fd, 0, SEEK_END)));
  if (::pread(fd, bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) std::abort();
  ::close(fd);
  return bytes;
}

const std::vector<std::uint8_t>& good_segment() {
  static const std::vector<std::uint8_t> bytes = [] {
    auto writer = SegmentWriter::create(tiny(own_name("-good")));
    if (!writer) std::abort();
    fill(*writer);
    return bytes_of(own_name("-good"));
  }();
  return bytes;
}

std::vector<std::uint8_t> patched(std::vector<std::uint8_t> bytes, std::span<const std::uint8_t> input,
                                  bool may_resize) {
  while (input.size() > 5) {
    std::uint32_t offset;
    std::memcpy(&offset, input.data(), 4);
    const std::size_t length = std::min<std::size_t>(input[4] % 64U, input.size() - 5);
    const auto patch = input.subspan(5, length);
    input = input.subspan(5 + length);
    if (may_resize && offset >= 0xfffffff0U) {
      bytes.resize(length == 0 ? 0 : bytes.size() * (offset & 15U) / 8);
      continue;
    }
    if (bytes.empty()) break;
    for (std::size_t i = 0; i < length; ++i) bytes[(offset + i) % bytes.size()] = patch[i];
  }
  return bytes;
}

/// One object per process, written anew for every input.
class Object {
 public:
  Object() : name_(own_name("-mutated")), fd_(::shm_open(name_.c_str(), O_CREAT | O_RDWR, 0600)) {}
  ~Object() { ::shm_unlink(name_.c_str()); }
  Object(const Object&) = delete;
  Object& operator=(const Object&) = delete;

  const std::string& set(const std::vector<std::uint8_t>& bytes) const {
    if (::ftruncate(fd_, static_cast<off_t>(bytes.size())) != 0) std::abort();
    if (::pwrite(fd_, bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) std::abort();
    return name_;
  }

 private:
  std::string name_;
  int fd_;
};

void read_lines(const SegmentReader& reader) {
  LineCursor cursor;
  LineBatch batch;
  for (int i = 0; i < 4; ++i) {
    if (reader.read_lines(cursor, batch, 20) != ReadOutcome::ok) break;
    float sum = 0;
    for (const Line& line : batch.lines) {
      for (const SurfacePoint& point : batch.points_of(line)) sum += point.position.x();
    }
    if (batch.points.size() > 64) std::abort();
    volatile float used = sum;
    static_cast<void>(used);
  }
}

void read_everything(SegmentReader& reader) {
  DaemonStatus daemon;
  SensorStatus sensor;
  CameraReport camera;
  PoseSample pose;
  Picture picture;
  std::string text;
  std::vector<PoseSample> history;
  reader.status(daemon);
  reader.camera_status(camera);
  reader.configuration(text);
  reader.calibration(text);
  for (int station = -1; station <= kMaxStations; ++station) {
    reader.sensor_status(station, sensor);
    reader.latest_pose(station, pose);
    reader.pose_history(station, 0, INT64_MAX, history);
    PoseCursor cursor;
    std::uint64_t missed = 0;
    reader.new_poses(station, cursor, history, missed);
    reader.pose_rate(station);
  }
  if (history.size() > kMaxStations * 2 * 4U) std::abort();
  reader.picture(picture);
  reader.frame_rate();
  reader.counters();
  reader.latencies();
  reader.report(monotonic_now());
  reader.news(Topic::all);
  reader.wait(Topic::all, 0);
  read_lines(reader);
}

}  // namespace

void read_mutated_segment(std::span<const std::uint8_t> input) {
  static const Object object;
  const std::string& name = object.set(patched(good_segment(), input, true));
  auto reader = SegmentReader::attach({.name = name, .prefault = false});
  if (reader) return read_everything(*reader);
  if (reader.error().message.empty()) std::abort();  // every refusal has its sentence
}

namespace {

/// A writer with its server, and our own mapping of the mailbox between them.
struct Mailbox {
  Mailbox() : writer(SegmentWriter::create(tiny(own_name("-box")))), server(*writer) {
    const int fd = ::shm_open(control_name(own_name("-box")).c_str(), O_RDWR, 0);
    bytes = static_cast<std::uint8_t*>(
        ::mmap(nullptr, sizeof(ls_control), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0));
    ::close(fd);
    good.assign(bytes, bytes + sizeof(ls_control));
  }
  Result<SegmentWriter> writer;
  ControlServer server;
  std::uint8_t* bytes = nullptr;
  std::vector<std::uint8_t> good;
  Nanoseconds now = 0;
};

}  // namespace

void poll_mutated_mailbox(std::span<const std::uint8_t> input) {
  static Mailbox box;
  const std::vector<std::uint8_t> mutated = patched(box.good, input, false);
  std::copy(mutated.begin(), mutated.end(), box.bytes);
  std::size_t length = 0;
  for (int i = 0; i < 3; ++i) {
    box.server.poll(box.now += 11 * kSecond, [&](const ReceivedCommand& command) -> CommandAnswer {
      length += command.text.size();
      return {AnswerKind::refused, command.text};
    });
  }
  if (length > LS_CONTROL_SLOTS * sizeof(ls_request)) std::abort();
}

}  // namespace linescope::testing
