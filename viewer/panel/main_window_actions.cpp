// What the operator's actions do.
#include <QApplication>

#include "common/units.hpp"
#include "viewer/panel/banner_bar.hpp"
#include "viewer/panel/dialogs.hpp"
#include "viewer/panel/main_window.hpp"
#include "viewer/panel/scene_widget.hpp"

namespace linescope {
namespace {

constexpr double kTurnStep = 5;    ///< degrees per key
constexpr double kZoomStep = 1.1;  ///< per key

}  // namespace

void MainWindow::act(OperatorAction action) {
  switch (action) {
    case OperatorAction::scan:
      return scan_or_stop();
    case OperatorAction::clear:
      return clear();
    case OperatorAction::undo_sweep:
      return hooks_.command(CommandKind::undo_sweep);
    case OperatorAction::show_scan:
      return enter(Moment::scan);
    case OperatorAction::surface:
      return enter(Moment::surface);
    case OperatorAction::navigate:
      return enter(Moment::navigate);
    default:
      break;
  }
  if (action >= OperatorAction::show_points && action <= OperatorAction::close_holes)
    return act_on_surface(action);
  if (action >= OperatorAction::layout_one && action <= OperatorAction::flip_harvester)
    return act_on_views(action);
  if (action >= OperatorAction::turn_left && action <= OperatorAction::farther) return move_view(action);
  if (action >= OperatorAction::measure && action <= OperatorAction::save_picture)
    return act_on_files(action);
  act_on_window(action);
}

void MainWindow::scan_or_stop() {
  if (state_.live->link.state == LinkState::file) return hooks_.go_live();
  const bool scanning = state_.live->scan.scanning;
  hooks_.command(scanning ? CommandKind::stop : CommandKind::start);
  if (scanning) return;
  enter(Moment::scan);
}

void MainWindow::clear() {
  if (state_.live->link.state == LinkState::file) return hooks_.go_live();
  show_other_scan(surface_page_->options());
  hooks_.forget_scan();
  if (state_.live->link.state == LinkState::attached) hooks_.command(CommandKind::clear);
}

void MainWindow::act_on_surface(OperatorAction action) {
  switch (action) {
    case OperatorAction::show_points:
      return set_shown(Shown::points);
    case OperatorAction::show_grid:
      return set_shown(Shown::grid);
    case OperatorAction::show_surface:
      return set_shown(Shown::surface);
    case OperatorAction::show_wireframe:
      return set_shown(Shown::wireframe);
    case OperatorAction::normals:
      return surface_page_->toggle_normals();
    case OperatorAction::method:
      return surface_page_->next_method();
    case OperatorAction::finer:
      return surface_page_->step_interval(true);
    case OperatorAction::coarser:
      return surface_page_->step_interval(false);
    case OperatorAction::close_holes:
      return surface_page_->toggle_holes();
    default:
      break;
  }
}

void MainWindow::act_on_views(OperatorAction action) {
  switch (action) {
    case OperatorAction::layout_one:
      return scene().set_layout(ViewLayout::one);
    case OperatorAction::layout_one_and_three:
      return scene().set_layout(ViewLayout::one_and_three);
    case OperatorAction::layout_two_by_two:
      return scene().set_layout(ViewLayout::two_by_two);
    case OperatorAction::reset_view:
      scene().follow_harvester(false);
      return scene().reset_view();
    case OperatorAction::follow_harvester:
      return scene().follow_harvester(!scene().following());
    case OperatorAction::flip_harvester:
      return scene().flip_harvester_view();
    default:
      break;
  }
}

void MainWindow::move_view(OperatorAction action) {
  ViewPose pose = scene().view_pose();
  const double step = radians_from_degrees(kTurnStep);
  switch (action) {
    case OperatorAction::turn_left:
      pose.azimuth -= step;
      break;
    case OperatorAction::turn_right:
      pose.azimuth += step;
      break;
    case OperatorAction::turn_up:
      pose.elevation = std::min(pose.elevation + step, radians_from_degrees(90));
      break;
    case OperatorAction::turn_down:
      pose.elevation = std::max(pose.elevation - step, radians_from_degrees(-90));
      break;
    case OperatorAction::roll_left:
      pose.roll += step;
      break;
    case OperatorAction::roll_right:
      pose.roll -= step;
      break;
    case OperatorAction::nearer:
      pose.distance /= kZoomStep;
      break;
    case OperatorAction::farther:
      pose.distance *= kZoomStep;
      break;
    default:
      return;
  }
  scene().follow_harvester(false);
  scene().set_view_pose(pose);
}

void MainWindow::act_on_window(OperatorAction action) {
  switch (action) {
    case OperatorAction::diagnostics:
      if (diagnostics_ == nullptr) diagnostics_ = new DiagnosticsDialog(this);
      return diagnostics_->show();
    case OperatorAction::shortcuts:
      if (shortcuts_ == nullptr) shortcuts_ = new ShortcutsDialog(this);
      return shortcuts_->show();
    case OperatorAction::full_screen:
      return isFullScreen() ? showNormal() : showFullScreen();
    case OperatorAction::quit:
      close();
      return;
    default:
      break;
  }
}

}  // namespace linescope
