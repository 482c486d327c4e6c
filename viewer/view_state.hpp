// What the viewer knows at one instant, as plain data: filled by the threads that acquire and compute, drawn
// by the one that shows. No VTK, no Qt, no shared memory in here. Millimetres, radians, CLOCK_MONOTONIC.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/calibration.hpp"
#include "common/rigid_transform.hpp"
#include "common/status.hpp"
#include "common/surface_point.hpp"
#include "common/time.hpp"
#include "viewer/surface/hole_filler.hpp"
#include "viewer/surface/triangle_mesh.hpp"

namespace linescope {

/// The frame the surface is held in: the object's (sensor 2, as the thesis does), or the tracker's where
/// there is no object sensor.
enum class HeldIn : std::uint8_t { object, world };
struct Held {};  ///< frame tag for whichever of the two was chosen
/// As mesh files and sessions name it.
inline const char* frame_name(HeldIn held_in) {
  return held_in == HeldIn::object ? "Object" : "World";
}

/// The line to the daemon.
enum class LinkState : std::uint8_t {
  searching,  ///< no segment of that name
  attached,
  silent,   ///< the heartbeat stopped
  ended,    ///< the daemon left in good order, or its segment was removed
  refused,  ///< there is a segment, but it cannot be used
  file,     ///< a saved session or a mesh file is shown: no daemon is looked for
};

struct LinkView {
  LinkState state = LinkState::searching;
  std::string segment;    ///< its name
  std::string text;       ///< what is the matter, one sentence; empty while attached
  std::string daemon;     ///< program and version of the writer
  std::uint32_t pid = 0;  ///< of the writer, 0: none yet
  std::uint64_t session = 0;
  Nanoseconds heartbeat = 0;  ///< last sign of life; 0: none yet
};

enum class ToolRole : std::uint8_t { endoscope = 0, object = 1, harvester = 2 };
inline constexpr int kToolRoles = 3;

struct ToolView {
  int station = -1;  ///< 0-based; -1: no station has this role
  ToolState state = ToolState::never_seen;
  std::string reason;        ///< the daemon's sentence when not ok
  Nanoseconds acquired = 0;  ///< of the last good pose; 0: never
  Rigid<World, Sensor> world_from_sensor;
  double rate_hz = 0;  ///< measured
};

struct CameraView {
  ToolState state = ToolState::never_seen;
  std::string name;
  std::string reason;
  Nanoseconds last_picture = 0;
  double rate_hz = 0;
  float exposure_ms = 0;
};

/// Immutable once published; shared between threads.
struct CameraPicture {
  Nanoseconds time = 0;
  std::uint64_t frame = 0;
  int width = 0, height = 0, channels = 3;  ///< channels: 1 grey, 3 blue-green-red
  std::vector<std::uint8_t> pixels;         ///< rows without padding
  std::vector<Eigen::Vector2f> line;        ///< extracted line, px (u right, v down)
};

/// A named number for the diagnostics.
struct NamedCount {
  std::string name;
  std::uint64_t value = 0;
};
struct StageLatency {
  std::string name;
  std::uint64_t count = 0;
  Nanoseconds p50 = 0, p95 = 0, max = 0;
};
struct DiagnosticsView {
  std::vector<NamedCount> counters;
  std::vector<StageLatency> latencies;
};

/// Quality of the newest line.
struct LineView {
  Nanoseconds time = 0;  ///< 0: no line yet
  int points = 0;
  float coverage = 0;   ///< 0..1 of the picture's columns or rows
  float snr = 0;        ///< signal to noise, ratio
  float deviation = 0;  ///< mm
  double gap = 0;       ///< median distance camera to surface, mm; 0: not known
};

struct ScanView {
  bool scanning = false;
  bool full = false;
  std::uint32_t scan_id = 0;
  std::uint64_t lines = 0;  ///< placed in the held frame
  std::uint64_t points = 0;
  std::uint64_t lines_unplaced = 0;  ///< received, but the object's pose was not usable at their instant
  ToolState unplaced_because = ToolState::ok;  ///< of the newest of them
  std::uint64_t lines_missed = 0;              ///< published, but gone before they could be read
  std::uint64_t lines_damaged = 0;
  std::uint32_t point_capacity = 0;
  LineView newest;
};

/// The daemon's own words.
struct DaemonView {
  bool known = false;
  std::string state;     ///< "idle", "scanning", "segment full", "camera lost" ...
  bool trouble = false;  ///< the state needs the operator
  std::string reason;
};

struct LiveView {
  Nanoseconds time = 0;  ///< when it was put together
  HeldIn held_in = HeldIn::object;
  LinkView link;
  DaemonView daemon;
  std::array<ToolView, kToolRoles> tools;
  CameraView camera;
  ScanView scan;
  bool calibration_known = false;
  std::string calibration_name;
  std::string calibration_trouble;  ///< why the daemon's calibration cannot be used
  HarvesterCalibration harvester;
  /// As the daemon published them; null: not known.
  std::shared_ptr<const std::string> configuration_text, calibration_text;
  std::shared_ptr<const CameraPicture> picture;
  std::shared_ptr<const DiagnosticsView> diagnostics;

  const ToolView& tool(ToolRole role) const { return tools[static_cast<std::size_t>(role)]; }
  ToolView& tool(ToolRole role) { return tools[static_cast<std::size_t>(role)]; }
};

/// One laser line in the held frame; immutable and shared by everybody who needs it.
struct HeldLine {
  std::uint64_t serial = 0;
  Nanoseconds time = 0;
  Eigen::Vector3d seen_from{0, 0, 0};  ///< the camera's centre
  std::vector<SurfacePoint> points;
};
using HeldLines = std::vector<std::shared_ptr<const HeldLine>>;

/// What happened to the scan since the last one: first forget (when said), then take the lines.
struct LineNews {
  bool forget = false;
  HeldLines lines;
};

/// The newest surface.
struct SurfaceView {
  std::shared_ptr<const TriangleMesh> mesh;
  std::shared_ptr<const std::vector<Eigen::Vector3f>> grid;
  std::uint64_t version = 0;  ///< grows with every new mesh
  std::string method;         ///< for people
  double interval = 0;        ///< mm
  std::uint64_t lines = 0;    ///< in it
  std::uint64_t points = 0;
  std::uint64_t points_refused = 0;
  std::size_t filled = 0;           ///< triangles that close holes
  std::optional<HoleCounts> holes;  ///< where closing them was asked for when this mesh was made
  double area = 0;                  ///< of all triangles, mm^2
  double seen_area = 0;  ///< of those that face the camera: a closed skin has a back nobody scanned
  Nanoseconds took = 0;  ///< to bring it up to date
  bool busy = false;     ///< lines are waiting or a mesh is being made
  std::string fault;     ///< options that cannot be
};

/// The newest answer to "by how much is the harvester off the normal".
struct NavigationView {
  bool asked = false;  ///< false: poses were not good enough to ask
  bool good = false;
  std::string reason;  ///< why it is not good
  std::string method;
  Nanoseconds harvester_time = 0;  ///< of the poses it rests on
  Nanoseconds object_time = 0;
  Eigen::Vector3d tip{0, 0, 0};   ///< held frame
  Eigen::Vector3d axis{0, 0, 1};  ///< from the tip to the handle, unit
  Eigen::Vector3d foot{0, 0, 0};
  Eigen::Vector3d normal{0, 0, 1};
  double angle = 0, angle_low = 0, angle_high = 0;  ///< radians; low and high NaN: not known
  double distance = 0;                              ///< tip to surface, mm, positive outside
  double depth = 0;                                 ///< along the axis, mm
  double uncertainty = 0;     ///< half angle of the normal's 95 % cone, radians; NaN: not known
  int points = 0, lines = 0;  ///< it stands on
};

/// An answer or event for the operator, newest last.
struct Notice {
  enum class Kind : std::uint8_t { information, refusal };
  Nanoseconds time = 0;
  Kind kind = Kind::information;
  std::string text;
};

/// All of it, as the display tick finds it.
struct ViewState {
  std::shared_ptr<const LiveView> live = std::make_shared<LiveView>();
  std::shared_ptr<const SurfaceView> surface = std::make_shared<SurfaceView>();
  std::shared_ptr<const NavigationView> navigation = std::make_shared<NavigationView>();
};

}  // namespace linescope
