#include "acquire/sources.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "acquire/camera/camera_choice.hpp"
#include "acquire/camera/camera_list.hpp"
#include "acquire/camera/no_camera.hpp"
#include "acquire/camera/picture_folder.hpp"
#include "acquire/record/recorded_camera.hpp"
#include "acquire/record/recorded_tracker.hpp"
#include "acquire/record/recording.hpp"
#include "acquire/tracker/csv_reader.hpp"
#include "acquire/tracker/liberty/find_trackers.hpp"
#include "acquire/tracker/liberty/liberty_source.hpp"
#include "acquire/tracker/picture_pose_source.hpp"
#include "acquire/tracker/timed_pose_source.hpp"
#include "acquire/twin/twin_camera.hpp"
#include "acquire/twin/twin_tracker.hpp"

namespace linescope {
namespace {

namespace fs = std::filesystem;
using Refused = tl::unexpected<Refusal>;

Refused refuse(ExitCode exit, std::string message) {
  return Refused(Refusal{exit, std::move(message)});
}

bool is_twin(const AcquireOptions& options) {
  return options.camera.source == "twin";
}

Result<Calibration> named_calibration(const std::string& choice) {
  if (choice == "thesis-camera-i") return thesis_camera_i();
  if (choice == "thesis-camera-ii") return thesis_camera_ii();
  return load_calibration(choice);
}

Nanoseconds file_period(const CameraChoice& camera) {
  return nanoseconds_from_seconds(1.0 / camera.file_rate_hz);
}

// --- the twin
// -------------------------------------------------------------------------------------------------------

Result<twin::TwinOptions> twin_options(const TwinChoice& choice, Nanoseconds start) {
  twin::TwinOptions o = twin::demo_twin();
  o.seed = static_cast<std::uint64_t>(choice.seed);
  o.start = start;
  o.duration = nanoseconds_from_seconds(choice.duration_s);
  auto phantom = twin::phantom_from_name(choice.phantom);
  if (!phantom) return tl::unexpected(phantom.error());
  o.phantom = *phantom;
  auto scenario = twin::scenario_from_name(choice.scenario);
  if (!scenario) return tl::unexpected(scenario.error());
  o.hand.scenario = *scenario;
  auto instrument = twin::instrument_from_name(choice.instrument);
  if (!instrument) return tl::unexpected(instrument.error());
  o.instrument = *instrument;
  if (auto noise = twin::apply_noise_preset(o, choice.noise); !noise) return tl::unexpected(noise.error());
  if (choice.optics != "preset") {
    auto optics = twin::optics_from_name(choice.optics);
    if (!optics) return tl::unexpected(optics.error());
    o.optics = *optics;
  }
  if (!choice.laser) o.optics.line.brightness = 0;
  if (choice.led >= 0) o.optics.light.led_brightness = choice.led;
  o.instrument.latency = nanoseconds_from_seconds(1e-3 * choice.camera_latency_ms);
  o.hand.gap_mm = choice.gap_mm;
  o.hand.gap_variation_mm = choice.gap_variation_mm;
  return o;
}

Result<void> write_truth(const twin::VirtualExperiment& experiment, const TwinChoice& choice) {
  if (choice.truth.empty()) return {};
  // A scenario without end is described for its first minute.
  const double seconds = choice.duration_s > 0 ? choice.duration_s : 60;
  std::ofstream out(choice.truth);
  out << experiment.truth().json(nanoseconds_from_seconds(seconds), 60);
  out.close();
  if (!out)
    return fail(ErrorCode::permission,
                fmt::format("twin.truth {}: cannot be written", choice.truth.string()));
  return {};
}

tl::expected<Sources, Refusal> twin_sources(const AcquireOptions& options, Nanoseconds start, Begin begin) {
  auto chosen = twin_options(options.twin, start);
  if (!chosen) return refuse(ExitCode::configuration, chosen.error().message);
  auto experiment = twin::VirtualExperiment::create(*chosen);
  if (!experiment) return refuse(ExitCode::configuration, experiment.error().message);
  if (begin == Begin::start) {
    if (auto truth = write_truth(**experiment, options.twin); !truth)
      return refuse(ExitCode::configuration, truth.error().message);
  }
  Sources sources;
  sources.camera = std::make_unique<twin::TwinCamera>(*experiment);
  sources.tracker = std::make_unique<twin::TwinTracker>(*experiment);
  sources.calibration = (*experiment)->calibration();
  if (auto ok = sources.camera->start(); !ok) return refuse(ExitCode::camera, ok.error().message);
  return sources;
}

// --- files and devices
// ----------------------------------------------------------------------------------------------

bool is_folder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

/// What a camera is opened with: automatic exposure for the line begins in the middle of its range.
double start_exposure(const CameraChoice& camera) {
  if (camera.exposure_ms < 0) return 0;
  if (camera.exposure_ms > 0) return camera.exposure_ms;
  return std::sqrt(camera.line_exposure.min_exposure_ms * camera.line_exposure.max_exposure_ms);
}

Result<std::unique_ptr<CameraSource>> camera_source(const AcquireOptions& options, const CameraModel& camera,
                                                    Nanoseconds start) {
  CameraOptions o;
  if (options.camera.source == "none") return std::make_unique<NoCamera>();
  o.source = options.camera.source;
  o.device = options.camera.device;
  o.device.exposure_ms = start_exposure(options.camera);
  o.start_time = start;
  if (is_folder(o.source)) o.period = file_period(options.camera);
  o.width = camera.width;
  o.height = camera.height;
  return make_camera(o);
}

/// A pose file that names pictures belongs to a folder of pictures; one with times stands for itself.
Result<bool> names_pictures(const fs::path& file) {
  std::ifstream in(file);
  if (!in)
    return fail(ErrorCode::not_found,
                fmt::format("pose file {}: no such file, or not readable", file.string()));
  std::string header;
  std::getline(in, header);
  return header.rfind("frame,", 0) == 0;
}

Result<std::vector<PictureInstant>> picture_instants(const AcquireOptions& options, Nanoseconds latency,
                                                     Nanoseconds start) {
  auto pictures = list_pictures(
      {.folder = options.camera.source, .start_time = start, .period = file_period(options.camera)});
  if (!pictures) return tl::unexpected(pictures.error());
  std::vector<PictureInstant> instants;
  for (const TimedPicture& picture : *pictures) instants.push_back({picture.name, picture.time - latency});
  return instants;
}

Result<std::unique_ptr<TrackerSource>> pose_file(const AcquireOptions& options, Nanoseconds latency,
                                                 Nanoseconds start) {
  const fs::path file = options.tracker.source;
  auto by_picture = names_pictures(file);
  if (!by_picture) return tl::unexpected(by_picture.error());
  if (!*by_picture) return std::make_unique<TimedPoseSource>(file, TimedPoseOptions{.first_row_at = start});
  if (!is_folder(options.camera.source)) {
    return fail(ErrorCode::mismatch, fmt::format("pose file {} names pictures, but the camera is \"{}\": "
                                                 "poses by picture need a folder of pictures",
                                                 file.string(), options.camera.source));
  }
  auto instants = picture_instants(options, latency, start);
  if (!instants) return tl::unexpected(instants.error());
  return std::make_unique<PicturePoseSource>(file, std::move(*instants),
                                             PicturePoseOptions{.station = options.tracker.roles.endoscope});
}

/// A device that is only looked for, everything else is started: files are read then.
Result<void> begin_camera(Sources& sources, const AcquireOptions& options, Begin begin) {
  if (begin == Begin::start || !sources.camera->live() || options.camera.source == "none")
    return sources.camera->start();
  auto found = choose_camera(options.camera.source, list_cameras());
  if (!found) return tl::unexpected(found.error());
  sources.camera_found = fmt::format("{} ({})", found->path, found->name);
  return {};
}

Result<void> begin_tracker(Sources& sources, const AcquireOptions& options, Begin begin) {
  if (!sources.tracker) return {};
  if (begin == Begin::start || !sources.tracker->live()) return sources.tracker->start();
  auto found = look_for_liberty(options.tracker.liberty);
  if (!found) return tl::unexpected(found.error());
  sources.tracker_found = "LIBERTY on " + *found;
  return {};
}

tl::expected<void, Refusal> choose_tracker(Sources& sources, const AcquireOptions& options,
                                           Nanoseconds start) {
  const std::string& source = options.tracker.source;
  if (source == "none") return {};
  const bool live = source == "liberty";
  if (live && !sources.camera->live()) {
    return refuse(ExitCode::configuration,
                  "recorded pictures and a live tracker do not belong to one instant: choose a camera, or "
                  "a file of poses");
  }
  if (!live && sources.camera->live()) {
    return refuse(ExitCode::configuration,
                  "a live camera and recorded poses do not belong to one instant: choose tracker \"liberty\" "
                  "or \"none\"");
  }
  if (live) {
    sources.tracker = std::make_unique<LibertySource>(options.tracker.liberty);
    return {};
  }
  auto tracker = pose_file(options, sources.calibration.camera_latency, start);
  if (!tracker) return refuse(ExitCode::tracker, tracker.error().message);
  sources.tracker = std::move(*tracker);
  return {};
}

tl::expected<Sources, Refusal> other_sources(const AcquireOptions& options, Nanoseconds start, Begin begin) {
  Sources sources;
  auto calibration = named_calibration(options.calibration);
  if (!calibration) return refuse(ExitCode::calibration, calibration.error().message);
  sources.calibration = std::move(*calibration);
  auto camera = camera_source(options, sources.calibration.camera, start);
  if (!camera) return refuse(ExitCode::camera, camera.error().message);
  sources.camera = std::move(*camera);
  // Started before the poses are read: a folder without pictures is the camera's fault, not the pose file's.
  if (auto ok = begin_camera(sources, options, begin); !ok)
    return refuse(ExitCode::camera, ok.error().message);
  if (auto chosen = choose_tracker(sources, options, start); !chosen) return Refused(chosen.error());
  return sources;
}

tl::expected<Sources, Refusal> replayed_sources(const std::filesystem::path& folder) {
  auto recording = open_recording(folder);
  if (!recording) return refuse(ExitCode::camera, recording.error().message);
  Sources sources;
  sources.calibration = recording->info.calibration;
  sources.camera = std::make_unique<RecordedCamera>(folder);
  sources.tracker = std::make_unique<RecordedTracker>(folder);
  if (auto ok = sources.camera->start(); !ok) return refuse(ExitCode::camera, ok.error().message);
  return sources;
}

tl::expected<Sources, Refusal> chosen_sources(const AcquireOptions& options, Nanoseconds start, Begin begin) {
  if (!options.run.replay.empty()) return replayed_sources(options.run.replay);
  return is_twin(options) ? twin_sources(options, start, begin) : other_sources(options, start, begin);
}

}  // namespace

tl::expected<Sources, Refusal> make_sources(const AcquireOptions& options, Nanoseconds start, Begin begin) {
  auto sources = chosen_sources(options, start, begin);
  if (!sources) return sources;
  const bool brings_its_own = is_twin(options) || !options.run.replay.empty();
  if (brings_its_own && !options.calibration.empty()) {
    auto calibration = named_calibration(options.calibration);
    if (!calibration) return refuse(ExitCode::calibration, calibration.error().message);
    sources->calibration = std::move(*calibration);
  }
  if (auto ok = validate(sources->calibration); !ok) return refuse(ExitCode::calibration, ok.error().message);
  if (auto ok = begin_tracker(*sources, options, begin); !ok)
    return refuse(ExitCode::tracker, ok.error().message);
  sources->live = sources->camera->live() || (sources->tracker && sources->tracker->live());
  return sources;
}

}  // namespace linescope
