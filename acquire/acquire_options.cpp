#include "acquire/acquire_options.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "common/units.hpp"
#include "ipc/segment_options.hpp"

namespace linescope {
namespace {

void declare_run(ConfigSchema& schema, RunOptions& run) {
  schema.section("run", "The daemon itself.");
  schema.text("run.segment", run.segment, "Name of the shared-memory segment.");
  schema.text("run.group", run.group,
              "Group whose members may read the segment; empty: only the user who started the daemon.");
  schema.number("run.capacity_minutes", run.capacity_minutes, {.unit = "min", .min = 0.1, .max = 600},
                "Scanning time for which the segment has room.");
  schema.flag("run.scan_at_start", run.scan_at_start, "Scan at once instead of waiting for the Scan button.");
  schema.choice("run.pace", run.pace, {{"real-time", Pace::real_time}, {"fast", Pace::fast}},
                "Speed at which recorded and simulated sources are played.");
  schema.path("run.record", run.record, "Folder to which pictures and samples are recorded; empty: none.");
  schema.integer("run.record_keep_free_mb", run.keep_free_mb, {.unit = "MB", .min = 0, .max = 1000000},
                 "A recording pauses before the disk has less room than this.");
  schema.path("run.replay", run.replay, "Recording to play instead of camera and tracker; empty: none.");
  schema.flag(
      "run.exit_at_end", run.exit_at_end,
      "End when a recorded source is through; otherwise the segment stays until the daemon is stopped.");
}

void declare_log(ConfigSchema& schema, LogOptions& log) {
  schema.section("log", "What the daemon says, and where.");
  schema.choice("log.level", log.level,
                {{"debug", LogLevel::debug},
                 {"info", LogLevel::info},
                 {"warning", LogLevel::warning},
                 {"error", LogLevel::error}},
                "From this level on.");
  schema.choice(
      "log.style", log.style,
      {{"auto", LogStyle::automatic}, {"terminal", LogStyle::terminal}, {"journal", LogStyle::journal}},
      "Lines on standard error: with time and level, or with the level as the systemd journal reads "
      "it; auto: journal when systemd listens.");
  schema.path("log.file", log.file, "File that the log is appended to as well; empty: none.");
}

void declare_camera(ConfigSchema& schema, CameraChoice& camera) {
  schema.section("camera", "Where the pictures come from.");
  schema.text("camera.source", camera.source,
              "\"twin\", a folder of pictures, a video file, a camera (its path, its index, or part of its "
              "name), or \"none\": poses only.");
  schema.number("camera.file_rate_hz", camera.file_rate_hz, {.unit = "Hz", .min = 0.1, .max = 1000},
                "Pictures per second of a folder; a video brings its own.");
  V4l2Options& device = camera.device;
  schema.integer("camera.width", device.width, {.unit = "px", .min = 16, .max = 8192},
                 "Picture width asked of a camera.");
  schema.integer("camera.height", device.height, {.unit = "px", .min = 16, .max = 8192},
                 "Picture height asked of a camera.");
  schema.number("camera.rate_hz", device.rate_hz, {.unit = "Hz", .min = 1, .max = 1000},
                "Pictures per second asked of a camera.");
  schema.text("camera.pixel_format", device.pixel_format,
              "Four characters, for example MJPG or YUYV; empty: the camera's choice.");
  schema.number("camera.exposure_ms", camera.exposure_ms, {.unit = "ms", .min = -1, .max = 1000},
                "Exposure time; 0: automatic for the laser line; -1: the camera's own automatic, which suits "
                "the picture.");
  schema.number("camera.min_exposure_ms", camera.line_exposure.min_exposure_ms,
                {.unit = "ms", .min = 0.001, .max = 1000}, "Shortest exposure of the automatic.");
  schema.number("camera.max_exposure_ms", camera.line_exposure.max_exposure_ms,
                {.unit = "ms", .min = 0.01, .max = 1000},
                "Longest exposure of the automatic; longer smears the line of a moving hand.");
  schema.number("camera.gain", device.gain, {.min = -1, .max = 10000},
                "Gain in the camera's own unit; -1: left as it is.");
  schema.number("camera.white_balance_k", device.white_balance_k, {.unit = "K", .min = -1, .max = 12000},
                "White balance, locked at this colour temperature; 0: locked as it is; -1: left automatic.");
}

void declare_tracker(ConfigSchema& schema, TrackerChoice& tracker, TrackerKeys& keys) {
  schema.section("tracker", "Where the poses come from.");
  schema.text("tracker.source", tracker.source, "\"twin\", \"liberty\", \"none\", or a CSV file of poses.");
  schema.integer("tracker.endoscope_station", keys.endoscope_station, {.min = 0, .max = 8},
                 "Station of sensor 1, on the endoscope, as numbered on the unit.");
  schema.integer("tracker.object_station", keys.object_station, {.min = 0, .max = 8},
                 "Station of sensor 2, on the knee; 0: none.");
  schema.integer("tracker.harvester_station", keys.harvester_station, {.min = 0, .max = 8},
                 "Station of sensor 3, on the harvester; 0: none.");
  schema.number(
      "tracker.pose_mean_ms", keys.pose_mean_ms, {.unit = "ms", .min = 0, .max = 50},
      "A line's pose is the mean over this time about its picture: less noise, slow hands only; 0: the "
      "pose interpolated at that instant.");
}

void declare_liberty_port(ConfigSchema& schema, LibertyOptions& liberty) {
  schema.choice("liberty.port", liberty.port, {{"usb", LibertyPort::usb}, {"serial", LibertyPort::serial}},
                "How it is connected.");
  schema.text("liberty.usb_path", liberty.usb_path,
              "Bus and ports as in 1-2.3, where there are several; empty: the only one.");
  schema.text("liberty.serial_device", liberty.serial_device, "Device of the serial line.");
  schema.integer("liberty.baud", liberty.baud, {.unit = "baud", .min = 38400, .max = 115200},
                 "Speed of the serial line: 38400, 57600 or 115200.");
  schema.choice("liberty.format", liberty.format,
                {{"binary", LibertyFormat::binary}, {"ascii", LibertyFormat::ascii}},
                "Form of its records; text is for a unit that cannot do better.");
  schema.flag("liberty.required_at_start", liberty.required_at_start,
              "Refuse to start without a working unit; false: start and go on looking for it.");
}

void declare_liberty_output(ConfigSchema& schema, LibertyOptions& liberty) {
  schema.flag("liberty.ask_distortion", liberty.ask_distortion,
              "Ask for the distortion item; without it metal near by goes unnoticed.");
  schema.flag("liberty.ask_timestamp", liberty.ask_timestamp,
              "Ask for the unit's own time stamp; a slow serial line may have to do without.");
  schema.flag("liberty.ask_stylus", liberty.ask_stylus,
              "Ask for the stylus button; a slow serial line may have to do without.");
  schema.flag("liberty.fifo", liberty.fifo,
              "Keep 2300 bytes in the unit for a busy host; false: newest cycle only, losses are normal.");
}

void declare_liberty(ConfigSchema& schema, LibertyOptions& liberty, TrackerKeys& keys) {
  schema.section("liberty", "The Polhemus LIBERTY; used where the tracker is \"liberty\" (docs/liberty.md).");
  declare_liberty_port(schema, liberty);
  schema.integer("liberty.rate_hz", liberty.rate_hz, {.unit = "Hz", .min = 120, .max = 240},
                 "Cycles per second: 120 or 240.");
  schema.numbers("liberty.stations", keys.stations, {.min = 1, .max = 8}, {.max_items = 8},
                 "Stations to enable; empty: every one with a sensor.");
  schema.numbers(
      "liberty.hemisphere", keys.hemisphere, {.min = -1, .max = 1}, {.min_items = 3, .max_items = 3},
      "Direction from the transmitter into the half space the sensors stay in; [0, 0, 0]: the unit "
      "follows them.");
  schema.numbers("liberty.position_filter", keys.position_filter, {.min = 0, .max = 1}, {.max_items = 4},
                 "The unit's filter for positions: F, FLow, FHigh, Factor; empty: off (its lag is not "
                 "calibrated).");
  schema.numbers("liberty.attitude_filter", keys.attitude_filter, {.min = 0, .max = 1}, {.max_items = 4},
                 "The same for rotations.");
  schema.integer("liberty.distortion_limit", liberty.distortion_limit, {.min = 1, .max = 2},
                 "Level of the distortion item from which a pose counts as taken in a distorted field.");
  declare_liberty_output(schema, liberty);
  schema.number("liberty.answer_timeout_ms", keys.answer_timeout_ms, {.unit = "ms", .min = 10, .max = 60'000},
                "Longest wait for one answer while the unit is started; each question is asked three times.");
  schema.number("liberty.silence_limit_ms", keys.silence_limit_ms, {.unit = "ms", .min = 10, .max = 60'000},
                "A stream in which nothing comes for this long is started again.");
}

void declare_laser(ConfigSchema& schema, LineExtractorOptions& laser) {
  schema.section("laser", "How the laser line is found in a picture.");
  schema.choice("laser.colour", laser.colour, kLaserColourWords, "Colour of the laser.");
  schema.choice("laser.axis", laser.axis, kProfileAxisWords,
                "One point per column (line runs left to right) or per row (top to bottom).");
  schema.choice(
      "laser.centre", laser.centre,
      {{"gauss-weighted", CentreMethod::gauss_weighted}, {"weighted-mean", CentreMethod::weighted_mean}},
      "Middle of the line: Gauss-weighted, or the plain weighted mean of the thesis.");
  schema.integer("laser.colour_threshold", laser.colour_threshold,
                 {.unit = "grey levels", .min = 1, .max = 254},
                 "Colour excess from which a pixel may belong to the line.");
  schema.integer("laser.ridge_threshold", laser.ridge_threshold,
                 {.unit = "grey levels", .min = 0, .max = 254},
                 "Or this much brighter than both sides in the laser's channel; 0: off.");
  schema.number("laser.relative_threshold", laser.relative_threshold, {.min = 0, .max = 0.95},
                "Peak over the strong peaks of the same picture, at least; 0: off.");
  schema.number("laser.min_snr", laser.min_snr, {.min = 0, .max = 1000},
                "Peak over the picture's noise, at least.");
  schema.number("laser.max_width", laser.max_width, {.unit = "px", .min = 1, .max = 4096},
                "A broader band of light is no line.");
  schema.integer("laser.min_run", laser.min_run, {.unit = "profiles", .min = 1, .max = 4096},
                 "A shorter connected piece is a glint.");
}

void declare_reconstruct(ConfigSchema& schema, AcquireOptions& options) {
  schema.section("reconstruct", "From the line to points.");
  schema.text("reconstruct.calibration", options.calibration,
              "Calibration file, \"thesis-camera-i\" or \"thesis-camera-ii\"; empty: the twin's own.");
  LineReconstructorOptions& r = options.reconstruct;
  schema.number("reconstruct.min_depth_mm", r.min_depth_mm, {.unit = "mm", .min = 0, .max = 10000},
                "Nearer points are dropped and counted.");
  schema.number("reconstruct.max_depth_mm", r.max_depth_mm, {.unit = "mm", .min = 0.1, .max = 10000},
                "Farther points are dropped and counted.");
  schema.number("reconstruct.line_noise_px", r.line_noise_px, {.unit = "px", .min = 0, .max = 10},
                "Noise of the line's middle beyond the camera's own noise (speckle, texture).");
}

void declare_twin(ConfigSchema& schema, TwinChoice& twin) {
  schema.section("twin", "The simulated instrument; used where a source is \"twin\".");
  schema.integer("twin.seed", twin.seed, {.min = 0}, "Same seed, same bytes.");
  schema.text(
      "twin.phantom", twin.phantom,
      "condyle, plane, cylinder-DIAMETER, sphere-DIAMETER, mini-knee, board, or a mesh (OFF file, in mm).");
  schema.choice("twin.scenario", twin.scenario,
                {"demo", "sweeps", "spots", "still", "board", "shake", "pivot", "spin"},
                "What the operator's hand does; the last four are for calibrating.");
  schema.choice("twin.noise", twin.noise, {"ideal", "manufacturer", "thesis"}, "How camera and tracker err.");
  schema.choice("twin.instrument", twin.instrument, {"camera-i", "camera-ii", "camera-ii-320", "near"},
                "Endoscope and prism: the thesis's, or one for gaps of 5 to 8 mm.");
  schema.choice(
      "twin.optics", twin.optics, {"preset", "ideal", "clean", "full", "trouble"},
      "What light goes through: as twin.noise says; nothing that disturbs; sensor, speckle and LED; also "
      "the bent sheet and the port; also everything that goes wrong in a knee.");
  schema.number("twin.gap_mm", twin.gap_mm, {.unit = "mm", .min = 2, .max = 100},
                "Mean distance from the camera to the surface.");
  schema.number("twin.gap_variation_mm", twin.gap_variation_mm, {.unit = "mm", .min = 0, .max = 50},
                "How far the hand departs from it, slowly, to both sides.");
  schema.flag("twin.laser", twin.laser, "The laser is on.");
  schema.number(
      "twin.led", twin.led, {.min = -1, .max = 1000},
      "Brightness of the white light, grey levels of a white surface at 15 mm; -1: as twin.noise says.");
  schema.number("twin.camera_latency_ms", twin.camera_latency_ms, {.unit = "ms", .min = -500, .max = 500},
                "By how much the pictures' time stamps are late.");
  schema.number("twin.duration_s", twin.duration_s, {.unit = "s", .min = 0, .max = 1e6},
                "End of the experiment; 0: never.");
  schema.path("twin.truth", twin.truth, "File to which the truth is written (JSON); empty: nowhere.");
}

Result<void> roles_apart(const StationRoles& r) {
  const auto same = [](int a, int b) { return a >= 0 && a == b; };
  if (same(r.endoscope, r.object) || same(r.endoscope, r.harvester) || same(r.object, r.harvester)) {
    return fail(ErrorCode::invalid, fmt::format("two tools share a station (endoscope {}, object {}, "
                                                "harvester {}): give each its own in [tracker]",
                                                r.endoscope + 1, r.object + 1, r.harvester + 1));
  }
  if (r.endoscope < 0)
    return fail(ErrorCode::invalid,
                "tracker.endoscope_station is 0: without the endoscope's pose no point can be placed");
  return {};
}

Result<void> validate_stages(const AcquireOptions& options) {
  if (auto exposure = validate(options.camera.line_exposure); !exposure) return exposure;
  if (auto laser = validate(options.laser); !laser) return laser;
  if (auto reconstruct = validate(options.reconstruct); !reconstruct) return reconstruct;
  return validate(options.tracker.history);
}

}  // namespace

void declare(ConfigSchema& schema, AcquireOptions& options) {
  declare_run(schema, options.run);
  declare_log(schema, options.log);
  declare_camera(schema, options.camera);
  declare_tracker(schema, options.tracker, options.tracker_keys);
  declare_liberty(schema, options.tracker.liberty, options.tracker_keys);
  declare_laser(schema, options.laser);
  declare_reconstruct(schema, options);
  declare_twin(schema, options.twin);
}

Result<void> apply_keys(const TrackerKeys& keys, TrackerChoice& tracker) {
  tracker.roles = {keys.endoscope_station - 1, keys.object_station - 1, keys.harvester_station - 1};
  tracker.history.mean_over = static_cast<Nanoseconds>(keys.pose_mean_ms * double{kMillisecond});
  LibertyOptions& liberty = tracker.liberty;
  liberty.answer_timeout = static_cast<Nanoseconds>(keys.answer_timeout_ms * double{kMillisecond});
  liberty.silence_limit = static_cast<Nanoseconds>(keys.silence_limit_ms * double{kMillisecond});
  liberty.stations = 0;
  for (const double station : keys.stations) {
    if (station != std::floor(station))
      return fail(ErrorCode::invalid,
                  fmt::format("liberty.stations holds {}: whole numbers 1 to 8", station));
    liberty.stations =
        static_cast<std::uint8_t>(liberty.stations | 1U << (static_cast<unsigned>(station) - 1U));
  }
  liberty.hemisphere = Eigen::Vector3d(keys.hemisphere[0], keys.hemisphere[1], keys.hemisphere[2]);
  const auto filter = [](const char* key, const std::vector<double>& four,
                         std::optional<LibertyFilter>& out) -> Result<void> {
    out.reset();
    if (four.empty()) return {};
    if (four.size() != 4)
      return fail(ErrorCode::invalid,
                  fmt::format("{} holds {} numbers: F, FLow, FHigh and Factor, or none", key, four.size()));
    out = LibertyFilter{four[0], four[1], four[2], four[3]};
    return {};
  };
  if (auto ok = filter("liberty.position_filter", keys.position_filter, liberty.position_filter); !ok)
    return ok;
  return filter("liberty.attitude_filter", keys.attitude_filter, liberty.attitude_filter);
}

Result<void> validate(const AcquireOptions& options) {
  if (auto segment = validate(SegmentOptions{.name = options.run.segment, .group = options.run.group});
      !segment)
    return segment;
  if (auto roles = roles_apart(options.tracker.roles); !roles) return roles;
  if (options.tracker.source == "liberty") {
    if (auto liberty = validate(options.tracker.liberty); !liberty) return liberty;
  }
  if (auto stages = validate_stages(options); !stages) return stages;
  if (!options.run.replay.empty()) return {};
  if ((options.camera.source == "twin") != (options.tracker.source == "twin")) {
    return fail(
        ErrorCode::invalid,
        "camera and tracker of the twin belong to one experiment: choose \"twin\" for both or for neither");
  }
  if (options.camera.source == "none" && options.tracker.source != "liberty") {
    return fail(ErrorCode::invalid,
                "camera \"none\" is for poses of a live tracker: choose tracker \"liberty\"");
  }
  if (options.camera.source != "twin" && options.calibration.empty()) {
    return fail(ErrorCode::invalid,
                "no calibration: give --calibration FILE (or thesis-camera-i, thesis-camera-ii) for pictures "
                "that are not the twin's");
  }
  return {};
}

}  // namespace linescope
