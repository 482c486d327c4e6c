// Everything that can be chosen about linescope-acquire: one struct, filled from the configuration file and
// the command line, printed by --print-config.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "acquire/camera/v4l2_device.hpp"
#include "acquire/laser/line_extractor_options.hpp"
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
  std::string group;         ///< group that may read the segment; empty: only this user
  int capacity_minutes = 5;  ///< scanning time the segment holds at 30 lines per second
  bool scan_at_start = false;
  Pace pace = Pace::real_time;
  std::filesystem::path record;  ///< folder to record everything to; empty: nothing is recorded
  std::filesystem::path replay;  ///< recording to play instead of camera and tracker; empty: none
  bool exit_at_end = false;      ///< stop when a recorded source has given its last picture
};

struct CameraChoice {
  std::string source = "twin";  ///< "twin", a folder, a video file, or a camera
  V4l2Options device;
  double file_rate_hz = 30;  ///< pictures per second of a folder
};

struct TrackerChoice {
  std::string source = "twin";  ///< "twin", "liberty", "none" or a CSV file
  StationRoles roles;
  LibertyOptions liberty;
  PoseHistoryOptions history;
  Nanoseconds longest_wait = 60 * kMillisecond;  ///< for the poses of a picture to arrive
};

struct TwinChoice {
  std::int64_t seed = 1;
  std::string phantom = "condyle";
  std::string scenario = "demo";
  std::string noise = "manufacturer";
  double duration_s = 0;        ///< 0: for ever
  std::filesystem::path truth;  ///< where to write what really is (JSON), for tests and evaluation
};

struct AcquireOptions {
  RunOptions run;
  CameraChoice camera;
  TrackerChoice tracker;
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
