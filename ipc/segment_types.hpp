// What goes through the segment, in the C++ types of both sides. The layout in memory is
// ipc/segment_layout.h.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "common/pose_sample.hpp"
#include "common/rigid_transform.hpp"
#include "common/status.hpp"
#include "common/time.hpp"
#include "ipc/segment_counters.h"
#include "ipc/segment_layout.h"

namespace linescope {

/// What the daemon is doing.
enum class DaemonState : std::uint32_t {
  starting = LS_STATE_STARTING,
  idle = LS_STATE_IDLE,
  scanning = LS_STATE_SCANNING,
  full = LS_STATE_FULL,  ///< no room for more lines; poses and pictures go on
  camera_lost = LS_STATE_CAMERA_LOST,
  tracker_lost = LS_STATE_TRACKER_LOST,
  stopping = LS_STATE_STOPPING,
};
std::string_view name(DaemonState state);

struct DaemonStatus {
  DaemonState state = DaemonState::starting;
  Nanoseconds since = 0;
  std::string reason;  ///< one sentence, may be empty; cut at 231 bytes
};

/// What a tracker sensor is fixed to.
enum class SensorRole : std::uint32_t {
  none = LS_ROLE_NONE,
  endoscope = LS_ROLE_ENDOSCOPE,
  object = LS_ROLE_OBJECT,
  harvester = LS_ROLE_HARVESTER,
  other = LS_ROLE_OTHER,
};
std::string_view name(SensorRole role);

struct SensorStatus {
  SensorRole role = SensorRole::none;
  ToolState state = ToolState::never_seen;
  Nanoseconds time = 0;       ///< of this statement
  Nanoseconds last_good = 0;  ///< last sample in state ok; 0: never
  std::uint64_t samples = 0;  ///< received so far
  std::uint64_t lost = 0;     ///< numbered by the tracker, never arrived
  float nominal_hz = 0;       ///< 0: unknown
  std::string name;           ///< for people; cut at 31 bytes
  std::string reason;         ///< one sentence when not ok; cut at 167 bytes
};

/// Named apart from the camera interface's CameraStatus (acquire/camera): the daemon uses both.
struct CameraReport {
  ToolState state = ToolState::never_seen;
  Nanoseconds time = 0;       ///< of this statement
  Nanoseconds last_good = 0;  ///< last readable picture; 0: never
  std::uint64_t frames = 0;   ///< received so far
  std::uint32_t width = 0;    ///< px
  std::uint32_t height = 0;   ///< px
  float nominal_hz = 0;       ///< 0: unknown
  float exposure_ms = 0;      ///< 0: unknown
  std::string name;           ///< device, file or folder; cut at 63 bytes
  std::string reason;         ///< one sentence when not ok; cut at 135 bytes
};

/// Pose of a tool at a line's instant, with what it is worth.
template <class Tool>
struct LinePose {
  Rigid<World, Tool> world_from_tool;
  ToolState state = ToolState::never_seen;
};

struct LineQuality {
  float mean_peak = 0;         ///< grey levels
  float mean_width = 0;        ///< px
  float mean_snr = 0;          ///< signal to noise, ratio
  float mean_deviation = 0;    ///< mm, along the viewing direction
  float coverage = 0;          ///< columns (or rows) with a point / all, 0..1
  std::uint32_t rejected = 0;  ///< candidates of this picture that gave no point
  Nanoseconds pose_gap = 0;    ///< distance of the two endoscope samples around the picture
};

/// Everything about a line but its points.
struct ScanLineInfo {
  Nanoseconds time = 0;     ///< middle of the exposure
  std::uint64_t frame = 0;  ///< running number of the camera's picture
  LinePose<Endoscope> endoscope;
  LinePose<Object> object;
  LinePose<Harvester> harvester;
  LineQuality quality;
};

/// A line as read back: the info plus its place in the scan.
struct Line : ScanLineInfo {
  std::uint64_t serial = 0;       ///< running number over the whole session; gaps tell what was missed
  std::uint32_t scan_id = 0;      ///< 1, 2 ...
  std::uint32_t index = 0;        ///< in its scan
  std::uint32_t point_count = 0;  ///<
  std::uint64_t first_point =
      0;  ///< LineBatch: element of its points; otherwise element of the segment's points
  std::uint64_t checksum = 0;
};

/// u, v (px), peak, snr. Named apart from the extraction's LineSample (acquire/laser): the daemon uses both.
using PictureSample = ls_line_sample;

enum class PixelFormat : std::uint32_t { gray8 = LS_PIXELS_GRAY8, bgr8 = LS_PIXELS_BGR8 };
constexpr std::uint32_t bytes_per_pixel(PixelFormat format) {
  return format == PixelFormat::bgr8 ? 3 : 1;
}

struct PictureInfo {
  Nanoseconds time = 0;      ///< middle of the exposure
  std::uint64_t frame = 0;   ///< running number of the camera's picture
  std::uint32_t width = 0;   ///< px
  std::uint32_t height = 0;  ///< px
  PixelFormat format = PixelFormat::bgr8;
  std::string_view name{};  ///< file name, may be empty; cut at 63 bytes
};

/// Everything counted; the names are those of ipc/segment_counters.h: Counter::frames_received.
enum class Counter : std::uint32_t {
#define LINESCOPE_COUNTER(name) name = LS_COUNT_##name,
  LS_COUNTERS(LINESCOPE_COUNTER)
#undef LINESCOPE_COUNTER
};
std::string_view name(Counter counter);

/// Stages whose duration is kept: LatencyStage::extract.
enum class LatencyStage : std::uint32_t {
#define LINESCOPE_LATENCY(name) name = LS_LATENCY_##name,
  LS_LATENCIES(LINESCOPE_LATENCY)
#undef LINESCOPE_LATENCY
};
std::string_view name(LatencyStage stage);

/// What a waiting reader wants to be woken for; values may be combined with |.
enum class Topic : std::uint32_t { lines = 1, poses = 2, pictures = 4, status = 8, all = 15 };
constexpr Topic operator|(Topic a, Topic b) {
  return static_cast<Topic>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}

/// The heartbeat's longest legal period, and the silence after which a writer counts as dead. Both leave a
/// reader that looks every 50 ms within the 0.2 s of DESIGN.md.
inline constexpr Nanoseconds kHeartbeatAtLeastEvery = 50 * kMillisecond;
inline constexpr Nanoseconds kDeadAfter = 150 * kMillisecond;

}  // namespace linescope
