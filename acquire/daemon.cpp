#include "acquire/daemon.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "acquire/acquisition.hpp"
#include "common/version.hpp"
#include "ipc/heartbeat.hpp"

namespace linescope {
namespace {

using Refused = tl::unexpected<Refusal>;

SegmentOptions segment_options(const RunOptions& run, const CameraModel& camera) {
  SegmentOptions o;
  o.name = run.segment;
  o.group = run.group;
  o.program = fmt::format("linescope-acquire {}", kVersion);
  const auto lines = static_cast<std::uint32_t>(run.capacity_minutes * 60 * 30);
  const auto profiles = static_cast<std::uint32_t>(std::max(camera.width, camera.height));
  o.line_capacity = lines;
  o.points_per_line = std::max(o.points_per_line, profiles);
  o.point_capacity = lines * static_cast<std::uint32_t>(camera.width);
  o.picture_bytes = static_cast<std::uint32_t>(camera.width) * static_cast<std::uint32_t>(camera.height) * 3u;
  o.picture_samples = std::max(o.picture_samples, profiles);
  return o;
}

RecordingInfo recording_info(const CommandLine& command, const Sources& sources) {
  RecordingInfo info;
  info.version = kVersion;
  info.camera = sources.camera->description();
  info.tracker = sources.tracker ? sources.tracker->description() : "none";
  info.configuration = command.configuration;
  info.calibration = sources.calibration;
  const StationRoles& roles = command.options.tracker.roles;
  info.endoscope_station = roles.endoscope;
  info.object_station = roles.object;
  info.harvester_station = roles.harvester;
  info.camera_period = sources.camera->period();
  return info;
}

ExitCode exit_of(const Error& segment_error) {
  return segment_error.code == ErrorCode::busy ? ExitCode::already_running : ExitCode::segment;
}

std::string description(const Sources& sources) {
  return fmt::format("camera: {}\ntracker: {}\ncalibration: {}", sources.camera->description(),
                     sources.tracker ? sources.tracker->description() : "none", sources.calibration.name);
}

/// Ends the run when the heartbeat finds the segment taken over.
class TakenOverWatch {
 public:
  TakenOverWatch(const Heartbeat& heartbeat, std::atomic<bool>& stop)
      : thread_([&heartbeat, &stop](const std::stop_token& done) {
          while (!done.stop_requested() && !stop) {
            if (heartbeat.lost()) stop = true;
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
          }
        }) {}

 private:
  std::jthread thread_;
};

}  // namespace

tl::expected<void, Refusal> run_daemon(const CommandLine& command, std::atomic<bool>& stop) {
  const AcquireOptions& options = command.options;
  auto sources = make_sources(options, monotonic_now());
  if (!sources) return Refused(sources.error());
  auto writer = SegmentWriter::create(segment_options(options.run, sources->calibration.camera));
  if (!writer) return Refused(Refusal{exit_of(writer.error()), writer.error().message});
  const Heartbeat heartbeat(*writer);
  writer->publish_configuration(command.configuration);
  if (auto yaml = calibration_text(sources->calibration)) writer->publish_calibration(*yaml);
  spdlog::info("segment {}\n{}", options.run.segment, description(*sources));
  const bool live = sources->live;
  auto acquisition = Acquisition::create(options, std::move(*sources), *writer, stop);
  if (!acquisition) return Refused(Refusal{ExitCode::calibration, acquisition.error().message});
  if (!options.run.record.empty()) {
    auto recorder =
        Recorder::start({.folder = options.run.record}, recording_info(command, (*acquisition)->sources));
    if (!recorder) return Refused(Refusal{ExitCode::failed, recorder.error().message});
    (*acquisition)->record_to(std::move(*recorder));
  }
  if (options.run.scan_at_start) (*acquisition)->scan.start(monotonic_now());
  {
    const TakenOverWatch watch(heartbeat, stop);
    live ? run_live(**acquisition) : run_stepped(**acquisition);
  }
  writer->set_state(DaemonState::stopping, "the daemon ends");
  if (heartbeat.lost())
    return Refused(Refusal{ExitCode::segment, "the segment was taken over or removed by somebody else"});
  return {};
}

tl::expected<std::string, Refusal> check_setup(const AcquireOptions& options) {
  auto sources = make_sources(options, monotonic_now());
  if (!sources) return Refused(sources.error());
  std::string text = description(*sources);
  for (const std::string& note : sources->calibration.notes) text += "\nnote: " + note;
  return text;
}

}  // namespace linescope
