#include "viewer/live_collector.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace linescope {
namespace {

// Rates and counters are for reading, not for watching: four times a second is enough and cheap.
constexpr Nanoseconds kFiguresEvery = 250 * kMillisecond;

bool needs_operator(DaemonState state) {
  return state == DaemonState::full || state == DaemonState::camera_lost ||
         state == DaemonState::tracker_lost || state == DaemonState::stopping;
}

std::optional<ToolRole> tool_role(SensorRole role) {
  switch (role) {
    case SensorRole::endoscope:
      return ToolRole::endoscope;
    case SensorRole::object:
      return ToolRole::object;
    case SensorRole::harvester:
      return ToolRole::harvester;
    case SensorRole::none:
    case SensorRole::other:
      break;
  }
  return std::nullopt;
}

ToolView without_station() {
  ToolView tool;
  tool.reason = "no tracker station has this role";
  return tool;
}

std::shared_ptr<const CameraPicture> picture_view(const Picture& picture) {
  auto view = std::make_shared<CameraPicture>();
  view->time = picture.time;
  view->frame = picture.frame;
  view->width = static_cast<int>(picture.width);
  view->height = static_cast<int>(picture.height);
  view->channels = static_cast<int>(bytes_per_pixel(picture.format));
  const std::size_t row = std::size_t{picture.width} * bytes_per_pixel(picture.format);
  view->pixels.resize(row * picture.height);
  for (std::size_t v = 0; v < picture.height; ++v)
    std::memcpy(view->pixels.data() + v * row, picture.pixels.data() + v * picture.stride, row);
  view->line.reserve(picture.samples.size());
  for (const PictureSample& s : picture.samples) view->line.emplace_back(s.u, s.v);
  return view;
}

}  // namespace

void LiveCollector::reset() {
  picture_ = {};
  calibration_text_.clear();
  calibration_.reset();
  next_figures_ = 0;
}

bool LiveCollector::collect(const SegmentReader& reader, Nanoseconds now, LiveView& view) {
  collect_daemon(reader, view);
  collect_calibration(reader, view);
  if (!collect_tools(reader, now, view)) return false;
  collect_camera(reader, now, view);
  collect_picture(reader, view);
  if (now >= next_figures_) collect_diagnostics(reader, now, view);
  view.scan.scanning = reader.scanning();
  view.scan.full = reader.full();
  view.scan.point_capacity = reader.identity().point_capacity;
  return true;
}

void LiveCollector::collect_daemon(const SegmentReader& reader, LiveView& view) {
  DaemonStatus status;
  if (reader.status(status) != ReadOutcome::ok) return;
  view.daemon = {.known = true,
                 .state = std::string(name(status.state)),
                 .trouble = needs_operator(status.state),
                 .reason = status.reason};
}

bool LiveCollector::collect_tools(const SegmentReader& reader, Nanoseconds now, LiveView& view) {
  std::array<bool, kToolRoles> seen{};
  for (int station = 0; station < kMaxStations; ++station) {
    SensorStatus status;
    const ReadOutcome outcome = reader.sensor_status(station, status);
    if (outcome == ReadOutcome::corrupt) return false;
    if (outcome != ReadOutcome::ok) continue;
    const auto role = tool_role(status.role);
    if (!role) continue;
    seen[static_cast<std::size_t>(*role)] = true;
    collect_tool(reader, station, now, view.tool(*role), status);
  }
  for (std::size_t role = 0; role < seen.size(); ++role)
    if (!seen[role]) view.tools[role] = without_station();
  return true;
}

void LiveCollector::collect_tool(const SegmentReader& reader, int station, Nanoseconds now, ToolView& tool,
                                 const SensorStatus& status) {
  tool.station = station;
  tool.state = status.state;
  tool.reason = status.reason;
  if (now >= next_figures_) tool.rate_hz = reader.pose_rate(station).hz;
  PoseSample pose;
  if (reader.latest_pose(station, pose) != ReadOutcome::ok) return;
  tool.state = worst(tool.state, pose.state);
  if (usable(pose.state)) {
    tool.acquired = pose.time;
    tool.world_from_sensor = pose.world_from_sensor;
  }
  tool.state = aged(tool.state, tool.acquired, now);
}

void LiveCollector::collect_camera(const SegmentReader& reader, Nanoseconds now, LiveView& view) {
  CameraReport report;
  if (reader.camera_status(report) != ReadOutcome::ok) return;
  view.camera.state = report.state;
  view.camera.name = report.name;
  view.camera.reason = report.reason;
  view.camera.last_picture = report.last_good;
  view.camera.exposure_ms = report.exposure_ms;
  if (now >= next_figures_) view.camera.rate_hz = reader.frame_rate().hz;
}

void LiveCollector::collect_picture(const SegmentReader& reader, LiveView& view) {
  if (reader.picture(picture_) == ReadOutcome::ok) view.picture = picture_view(picture_);
}

void LiveCollector::collect_calibration(const SegmentReader& reader, LiveView& view) {
  if (calibration_) return;
  std::string configuration, text;
  if (reader.configuration(configuration) == ReadOutcome::ok)
    view.configuration_text = std::make_shared<const std::string>(std::move(configuration));
  if (reader.calibration(text) != ReadOutcome::ok || text == calibration_text_) return;
  calibration_text_ = text;
  view.calibration_text = std::make_shared<const std::string>(text);
  auto calibration = calibration_from_text(text, "the daemon's calibration");
  view.calibration_known = calibration.has_value();
  if (!calibration) {
    view.calibration_trouble = calibration.error().message;
    return;
  }
  view.calibration_trouble.clear();
  view.calibration_name = calibration->name;
  view.harvester = calibration->harvester;
  calibration_ = std::move(*calibration);
}

void LiveCollector::collect_diagnostics(const SegmentReader& reader, Nanoseconds now, LiveView& view) {
  next_figures_ = now + kFiguresEvery;
  auto figures = std::make_shared<DiagnosticsView>();
  for (const CounterValue& c : reader.counters()) figures->counters.push_back({c.name, c.value});
  for (const LatencyFigures& l : reader.latencies())
    figures->latencies.push_back({l.name, l.count, l.p50, l.p95, l.max});
  view.diagnostics = std::move(figures);
}

void LiveCollector::mark_disconnected(LiveView& view, const std::string& why) {
  for (ToolView& tool : view.tools) {
    if (tool.state == ToolState::never_seen) continue;
    tool.state = ToolState::disconnected;
    tool.reason = why;
  }
  if (view.camera.state != ToolState::never_seen) view.camera.state = ToolState::disconnected;
  view.camera.reason = why;
  view.daemon.known = false;
  view.scan.scanning = false;
}

}  // namespace linescope
