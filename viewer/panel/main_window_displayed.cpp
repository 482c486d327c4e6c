// The window's texts as an object for scripts and tests.
#include <QJsonArray>
#include <QLabel>
#include <QPushButton>

#include "common/units.hpp"
#include "viewer/panel/angle_display.hpp"
#include "viewer/panel/banner_bar.hpp"
#include "viewer/panel/dialogs.hpp"
#include "viewer/panel/main_window.hpp"
#include "viewer/panel/navigate_page.hpp"
#include "viewer/panel/scene_widget.hpp"

namespace linescope {
namespace {

QJsonObject json(const StatusLine& line) {
  return {{"state", QString::fromStdString(line.word)}, {"detail", QString::fromStdString(line.detail)}};
}

QJsonObject json(const Readout& readout) {
  return {{"text", QString::fromStdString(readout.text)}, {"reason", QString::fromStdString(readout.reason)}};
}

QJsonObject json(const QRect& r) {
  return {{"x", r.x()}, {"y", r.y()}, {"width", r.width()}, {"height", r.height()}};
}

/// Where the buttons of the bar are in the window, by the actions' names.
QJsonObject places(const TopBar& bar, const QWidget& window) {
  QJsonObject all;
  for (const auto& [action, button] : bar.buttons())
    all[info(action).id] = json(QRect(button->mapTo(&window, QPoint()), button->size()));
  return all;
}

double number(std::uint64_t value) {
  return static_cast<double>(value);
}

const char* word(LinkState state) {
  switch (state) {
    case LinkState::searching:
      return "searching";
    case LinkState::attached:
      return "attached";
    case LinkState::silent:
      return "silent";
    case LinkState::ended:
      return "ended";
    case LinkState::refused:
      return "refused";
    case LinkState::file:
      return "file";
  }
  return "?";
}

}  // namespace

QJsonObject MainWindow::displayed_state() const {
  const LiveView& live = *state_.live;
  const Nanoseconds now = shown_at_;
  const AngleReadout& angle = shown_angle_;
  Scene& scene = views_->scene();
  return {
      {"time_ns", QString::number(monotonic_now())},
      {"moment", name(moment_)},
      {"link", word(live.link.state)},
      {"daemon_pid", static_cast<int>(live.link.pid)},
      {"angle_text", angle_->shown()},
      {"angle_reason", angle_->reason()},
      {"interval", json(angle.interval)},
      {"distance", json(angle.distance)},
      {"depth", json(angle.depth)},
      {"in_tolerance", angle.in_tolerance},
      {"gap", json(gap_readout(live, now))},
      {"pose_time_ns", QString::number(angle_->pose_time())},
      {"tools", QJsonObject{{"endoscope", json(tool_status(live, ToolRole::endoscope, now))},
                            {"object", json(tool_status(live, ToolRole::object, now))},
                            {"harvester", json(tool_status(live, ToolRole::harvester, now))},
                            {"camera", json(camera_status(live, now))},
                            {"daemon", json(daemon_status(live, now))}}},
      {"banner", banner_->text()},
      {"advice", banner_->advice()},
      {"notice", banner_->notice()},
      {"scanning", live.scan.scanning},
      {"full", live.scan.full},
      {"scan_id", static_cast<int>(live.scan.scan_id)},
      {"points", number(live.scan.points)},
      {"lines", number(live.scan.lines)},
      {"lines_unplaced", number(live.scan.lines_unplaced)},
      {"points_received", number(scene.cloud().received())},
      {"points_drawn", number(scene.cloud().drawn())},
      {"triangles", number(scene.surface().triangles())},
      {"grid_points", number(scene.surface().grid_points())},
      {"surface_visible", scene.surface().visible()},
      {"surface_version", number(state_.surface->version)},
      {"surface_method", QString::fromStdString(state_.surface->method)},
      {"surface_interval_mm", state_.surface->interval},
      {"surface_points", number(state_.surface->points)},
      {"normal_visible", scene.guidance().normal_visible()},
      {"harvester_visible", scene.guidance().harvester_visible()},
      {"harvester_ghosted", scene.guidance().harvester_ghosted()},
      {"wanted_interval_mm", surface_page_->options().interval},
      {"closing_holes_mm", surface_page_->options().fill_holes_up_to},
      {"surface_size", surface_page_->size_text()},
      {"filled_triangles", number(scene.surface().filled_triangles())},
      {"view_area", json(QRect(views_->mapTo(this, QPoint()), views_->size()))},
      {"buttons", places(*top_, *this)},
      {"measurement", surface_page_->measurement()},
      {"measured_mm", measured_.empty() ? 0 : measured_.back()},
      {"evaluation", surface_page_->evaluation().text()},
      {"evaluation_shape", name(surface_page_->evaluation().request().shape)},
      {"region_all", surface_page_->evaluation().request().region.all},
      {"region_visible", scene.marks().region_visible()},
      {"job", job_ ? QString::fromStdString(job_->title) : QString()},
      {"held", angle.held},
      {"sample_to_screen_ms", milliseconds_from(pose_shown_.summary().p95)},
      {"layout", static_cast<int>(scene.layout())},
      {"colour", name(surface_page_->colouring())},
      {"smooth", surface_page_->smooth()},
      {"flipped", scene.harvester_view_flipped()},
      {"following", scene.following()},
      {"azimuth_deg", degrees_from_radians(scene.view_pose().azimuth)},
      {"elevation_deg", degrees_from_radians(scene.view_pose().elevation)},
      {"roll_deg", degrees_from_radians(scene.view_pose().roll)},
      {"distance_mm", scene.view_pose().distance},
      {"diagnostics_open", diagnostics_ != nullptr && diagnostics_->isVisible()},
      {"keys_open", shortcuts_ != nullptr && shortcuts_->isVisible()},
      {"full_screen", isFullScreen()},
      {"views", static_cast<int>(scene.visible_views().size())},
      {"shown", static_cast<int>(surface_page_->shown())},
      {"event_wait_p95_ms", wait_.percentile(0.95)},
      {"draw_p95_ms", draw_.percentile(0.95)},
      {"graphics", QString::fromStdString(views_->graphics())},
  };
}

}  // namespace linescope
