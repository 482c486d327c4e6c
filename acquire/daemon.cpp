#include "acquire/daemon.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cmath>
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
  const auto lines = static_cast<std::uint32_t>(std::lround(run.capacity_minutes * 60 * 30));
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

RecorderOptions recorder_options(const RunOptions& run) {
  RecorderOptions o;
  o.folder = run.record;
  o.keep_free = static_cast<std::uint64_t>(run.keep_free_mb) << 20U;
  return o;
}

ExitCode exit_of(const Error& segment_error) {
  return segment_error.code == ErrorCode::busy ? ExitCode::already_running : ExitCode::segment;
}

struct Description {
  std::string camera, tracker, calibration;
};

Description description(const Sources& sources) {
  const std::string tracker = sources.tracker ? sources.tracker->description() : "none";
  return {sources.camera_found.empty() ? sources.camera->description() : sources.camera_found,
          sources.tracker_found.empty() ? tracker : sources.tracker_found, sources.calibration.name};
}

/// A recording that could not begin is told before anything runs.
Result<void> check_record_folder(const std::filesystem::path& folder) {
  std::error_code error;
  if (folder.empty() || !std::filesystem::exists(folder, error)) return {};
  if (std::filesystem::is_empty(folder, error)) return {};
  return fail(ErrorCode::busy,
              fmt::format("recording folder {} is not empty; name a new one", folder.string()));
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
  const Description what = description(*sources);
  spdlog::info("segment {}, camera {}, tracker {}, calibration {}", options.run.segment, what.camera,
               what.tracker, what.calibration);
  const bool live = sources->live;
  auto acquisition = Acquisition::create(options, std::move(*sources), *writer, stop);
  if (!acquisition) return Refused(Refusal{ExitCode::calibration, acquisition.error().message});
  if (!options.run.record.empty()) {
    auto recorder =
        Recorder::start(recorder_options(options.run), recording_info(command, (*acquisition)->sources));
    if (!recorder) return Refused(Refusal{ExitCode::failed, recorder.error().message});
    (*acquisition)->record_to(std::move(*recorder));
  }
  if (options.run.scan_at_start) (*acquisition)->scan.start(monotonic_now());
  {
    const TakenOverWatch watch(heartbeat, stop);
    live ? run_live(**acquisition) : run_stepped(**acquisition);
  }
  writer->set_state(DaemonState::stopping, "the daemon ends");
  spdlog::info("the daemon ends");
  if (heartbeat.lost())
    return Refused(Refusal{ExitCode::segment, "the segment was taken over or removed by somebody else"});
  return {};
}

tl::expected<std::string, Refusal> check_setup(const AcquireOptions& options) {
  auto sources = make_sources(options, monotonic_now(), Begin::look);
  if (!sources) return Refused(sources.error());
  if (auto folder = check_record_folder(options.run.record); !folder)
    return Refused(Refusal{ExitCode::configuration, folder.error().message});
  const Description what = description(*sources);
  std::string text =
      fmt::format("camera: {}\ntracker: {}\ncalibration: {}", what.camera, what.tracker, what.calibration);
  for (const std::string& note : sources->calibration.notes) text += "\nnote: " + note;
  return text;
}

}  // namespace linescope
