// Everything that can be chosen about linescope-acquire: one struct, filled from the configuration file and
// the command line, printed by --print-config.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "acquire/camera/line_exposure.hpp"
#include "acquire/camera/v4l2_device.hpp"
#include "acquire/laser/line_extractor_options.hpp"
#include "acquire/logging.hpp"
#include "acquire/reconstruct/line_reconstructor.hpp"
#include "acquire/tracker/liberty/liberty_options.hpp"
#include "acquire/tracker/pose_history.hpp"
#include "common/config_schema.hpp"
#include "common/time.hpp"

namespace linescope {

/// Which station (0-based) carries which tool; -1: none.
struct StationRoles {
  int endoscope = 0;
  int object = 1;
  int harvester = 2;
};

enum class Pace : std::uint8_t {
  real_time,  ///< recorded and simulated sources run at the speed of their time stamps
  fast,       ///< and as fast as they can be computed
};

struct RunOptions {
  std::string segment = "linescope";
  std::string group;            ///< group that may read the segment; empty: only this user
  double capacity_minutes = 5;  ///< scanning time the segment holds at 30 lines per second
  bool scan_at_start = false;
  Pace pace = Pace::real_time;
  std::filesystem::path record;  ///< folder to record everything to; empty: nothing is recorded
  int keep_free_mb = 256;        ///< a recording pauses before the disk has less than this
  std::filesystem::path replay;  ///< recording to play instead of camera and tracker; empty: none
  bool exit_at_end = false;      ///< stop when a recorded source has given its last picture
};

struct CameraChoice {
  std::string source = "twin";  ///< "twin", a folder, a video file, a camera, or "none"
  V4l2Options device;           ///< its exposure_ms is the start value of an automatic exposure
  double exposure_ms = 0;       ///< 0: automatic for the laser line; -1: the camera's own; else fixed
  LineExposureOptions line_exposure;
  double file_rate_hz = 30;  ///< pictures per second of a folder
};

/// The tracker's keys whose form in the file is not the one used inside: stations count from 1 there, as on
/// the unit and on every screen, and lists may be empty.
struct TrackerKeys {
  int endoscope_station = 1;  ///< 0: none
  int object_station = 2;
  int harvester_station = 3;
  std::vector<double> stations;  ///< enabled ones; empty: every station with a sensor
  std::vector<double> hemisphere{1, 0, 0};
  std::vector<double> position_filter;  ///< F, FLow, FHigh, Factor; empty: off
  std::vector<double> attitude_filter;
  double silence_limit_ms = 1000;
  double answer_timeout_ms = 1000;
  double pose_mean_ms = 0;
};

struct TrackerChoice {
  std::string source = "twin";  ///< "twin", "liberty", "none" or a CSV file
  StationRoles roles;
  LibertyOptions liberty;
  PoseHistoryOptions history;
  Nanoseconds longest_wait = 60 * kMillisecond;  ///< for the poses of a picture to arrive
};

/// Fills roles and LIBERTY options from the keys; the first fault in one sentence.
Result<void> apply_keys(const TrackerKeys& keys, TrackerChoice& tracker);

struct TwinChoice {
  std::int64_t seed = 1;
  std::string phantom = "condyle";
  std::string scenario = "demo";
  std::string noise = "manufacturer";
  std::string instrument = "camera-ii";
  std::string optics = "preset";  ///< "preset": as `noise` says
  double gap_mm = 15;             ///< mean distance camera - surface
  double gap_variation_mm = 3;    ///< to both sides of it
  bool laser = true;              ///< false: no line in the picture
  double led = -1;                ///< grey levels; negative: as `noise` says
  double camera_latency_ms = 0;
  double duration_s = 0;        ///< 0: for ever
  std::filesystem::path truth;  ///< where to write what really is (JSON), for tests and evaluation
};

struct AcquireOptions {
  RunOptions run;
  LogOptions log;
  CameraChoice camera;
  TrackerChoice tracker;
  TrackerKeys tracker_keys;  ///< as read; apply_keys() makes them count
  TwinChoice twin;
  std::string calibration;  ///< a file, "thesis-camera-i", "thesis-camera-ii"; empty: the twin's own
  LineExtractorOptions laser;
  LineReconstructorOptions reconstruct;
};

/// Declares every key of the configuration file. `options` must outlive `schema`.
void declare(ConfigSchema& schema, AcquireOptions& options);

/// First fault that no single key shows: roles that share a station, twin camera without twin tracker, and
/// the stages' own checks.
Result<void> validate(const AcquireOptions& options);

}  // namespace linescope
