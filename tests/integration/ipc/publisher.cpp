// A writer for tests: publishes made-up lines, poses and pictures as fast as it can (or at a rate) until it
// is told to end.
//   ipc-publisher NAME [lines per second, 0: full speed]
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "ipc/control.hpp"
#include "ipc/heartbeat.hpp"
#include "ipc/segment_writer.hpp"
#include "tests/integration/ipc/made_up_line.hpp"

namespace linescope::testing {
namespace {

std::atomic<bool> end_requested{false};

void request_end(int) {
  end_requested = true;
}

SegmentOptions options_of(const char* name) {
  SegmentOptions o;
  o.name = name;
  o.program = "ipc-publisher 1";
  o.point_capacity = 60'000;
  o.line_capacity = 150;
  o.picture_bytes = 160 * 120 * 3;
  return o;
}

/// 8 sensors; at full speed without a pause, which is a thousand times what a tracker does.
void publish_poses(SegmentWriter& writer, bool paced) {
  for (std::uint32_t i = 0; !end_requested; ++i) {
    for (std::uint8_t station = 0; station < kMaxStations; ++station) {
      PoseSample s;
      s.time = monotonic_now();
      s.frame_count = i;
      s.station = station;
      s.state = ToolState::ok;
      s.world_from_sensor = {Eigen::Quaterniond::Identity(), {1.0 * i, 1.0 * station, -1.0 * i}};
      writer.publish_pose(s);
    }
    std::this_thread::sleep_for(std::chrono::microseconds(paced ? 4167 : 100));
  }
}

class LinePublisher {
 public:
  LinePublisher(SegmentWriter& writer, double per_second)
      : writer_(writer), pause_(per_second > 0 ? 1e6 / per_second : 0) {
    writer_.begin_scan(monotonic_now());
    writer_.set_scanning(true);
  }

  void run() {
    while (!end_requested) {
      publish_one();
      if (pause_.count() > 0) std::this_thread::sleep_for(pause_);
    }
  }

 private:
  void publish_one() {
    if (writer_.lines_in_scan() == 150) writer_.begin_scan(monotonic_now());
    make_up(serial_, points_);
    if (writer_.publish_line(made_up_info(serial_, monotonic_now()), points_) != PublishOutcome::stored)
      std::abort();
    if (++serial_ % 16 == 0) publish_picture();
  }
  void publish_picture() {
    std::fill(pixels_.begin(), pixels_.end(), static_cast<std::byte>(serial_ / 16 % 256));
    const std::vector<PictureSample> samples{{1.5F, static_cast<float>(serial_ % 1000), 200, 10}};
    writer_.publish_picture({monotonic_now(), serial_, 160, 120, PixelFormat::bgr8, "made-up"},
                            pixels_.data(), 480, samples);
  }

  SegmentWriter& writer_;
  std::chrono::duration<double, std::micro> pause_;
  std::uint64_t serial_ = 0;
  std::vector<SurfacePoint> points_;
  std::vector<std::byte> pixels_ = std::vector<std::byte>(160 * 120 * 3);
};

void answer_commands(SegmentWriter& writer) {
  ControlServer server(writer);
  while (!end_requested) {
    server.wait(10 * kMillisecond);
    server.poll(monotonic_now(), [](const ReceivedCommand& command) -> CommandAnswer {
      if (command.kind == CommandKind::shut_down) request_end(0);
      if (command.kind == CommandKind::laser_brightness) return {AnswerKind::refused, "there is no laser"};
      return {AnswerKind::done, {}};
    });
  }
}

void describe(SegmentWriter& writer) {
  SensorStatus status;
  status.role = SensorRole::endoscope;
  status.state = ToolState::ok;
  status.name = "endoscope";
  status.nominal_hz = 240;
  writer.set_sensor_status(0, status);
  writer.publish_configuration("[camera]\nwidth = 160\n");
  writer.publish_calibration("%YAML:1.0\n");
  writer.set_state(DaemonState::scanning, "made-up lines");
}

int run(const char* name, double lines_per_second) {
  auto writer = SegmentWriter::create(options_of(name));
  if (!writer) {
    std::fprintf(stderr, "%s\n", writer.error().message.c_str());
    return 1;
  }
  const Heartbeat heartbeat(*writer);
  describe(*writer);
  std::thread poses([&] { publish_poses(*writer, lines_per_second > 0); });
  std::thread commands([&] { answer_commands(*writer); });
  LinePublisher(*writer, lines_per_second).run();
  poses.join();
  commands.join();
  std::printf("offered %llu published %llu\n",
              static_cast<unsigned long long>(writer->counted(Counter::lines_offered)),
              static_cast<unsigned long long>(writer->counted(Counter::lines_published)));
  return 0;
}

}  // namespace
}  // namespace linescope::testing

int main(int argc, char** argv) {
  if (argc < 2) return std::fprintf(stderr, "usage: ipc-publisher NAME [LINES_PER_SECOND]\n"), 2;
  std::signal(SIGTERM, linescope::testing::request_end);
  std::signal(SIGINT, linescope::testing::request_end);
  return linescope::testing::run(argv[1], argc > 2 ? std::atof(argv[2]) : 0);
}
