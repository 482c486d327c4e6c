// Measuring, evaluating, and what is kept in files.
#include <fmt/format.h>

#include <QDateTime>
#include <QFileDialog>

#include "viewer/panel/banner_bar.hpp"
#include "viewer/panel/dialogs.hpp"
#include "viewer/panel/main_window.hpp"
#include "viewer/panel/navigate_page.hpp"
#include "viewer/panel/scene_widget.hpp"

namespace linescope {

void MainWindow::act_on_files(OperatorAction action) {
  switch (action) {
    case OperatorAction::measure:
      stop_picking();
      picking_ = Picking::distance;
      set_moment(Moment::surface);
      return surface_page_->show_measurement("click the first point in the free view");
    case OperatorAction::region:
      return pick_region();
    case OperatorAction::next_shape:
      set_moment(Moment::surface);
      return surface_page_->evaluation().next_shape();
    case OperatorAction::evaluate:
      set_moment(Moment::surface);
      return hooks_.evaluate(surface_page_->evaluation().request());
    case OperatorAction::save_session:
      return hooks_.save_session();
    case OperatorAction::open_session:
      return choose_file();
    case OperatorAction::live:
      return hooks_.go_live();
    case OperatorAction::cancel:
      stop_picking();
      return hooks_.cancel();
    case OperatorAction::save_picture:
      return save_picture_now();
    default:
      break;
  }
}

void MainWindow::stop_picking() {
  if (picking_ == Picking::distance) clear_distance();
  if (picking_ == Picking::region) surface_page_->evaluation().clear_result();
  picking_ = Picking::nothing;
}

void MainWindow::clear_distance() {
  ends_.clear();
  scene().marks().set_distance(ends_);
  surface_page_->clear_measurement();
}

void MainWindow::pick_region() {
  stop_picking();
  set_moment(Moment::surface);
  EvaluationBox& box = surface_page_->evaluation();
  if (!box.request().region.all) return box.set_region(std::nullopt), box.clear_result();
  box.set_region(std::nullopt);
  picking_ = Picking::region;
  box.show_hint("click the middle of the region");
}

void MainWindow::mark_region() {
  const Region region = surface_page_->evaluation().request().region;
  if (region.all) return scene().marks().set_region(std::nullopt);
  scene().marks().set_region(MarkedRegion{region.centre, region.radius});
}

void MainWindow::clicked(int x, int y) {
  if (picking_ == Picking::nothing) return;
  const auto point = scene().pick(x, y);
  if (picking_ == Picking::distance) {
    if (!point) return surface_page_->show_measurement("no point there: click on the surface");
    return measure_click(*point);
  }
  if (!point) return surface_page_->evaluation().show_hint("no point there: click on the surface");
  picking_ = Picking::nothing;
  surface_page_->evaluation().set_region(*point);
  hooks_.evaluate(surface_page_->evaluation().request());
}

void MainWindow::measure_click(const Eigen::Vector3d& point) {
  ends_.push_back(point);
  scene().marks().set_distance(ends_);
  if (ends_.size() < 2) return surface_page_->show_measurement("click the second point");
  measured_.push_back((ends_[1] - ends_[0]).norm());
  surface_page_->show_measurement(QString("%1 mm").arg(measured_.back(), 0, 'f', 2));
  ends_.clear();
  picking_ = Picking::nothing;
}

void MainWindow::show_evaluation(const Result<ShapeEvaluation>& result) {
  surface_page_->evaluation().show_result(result);
}

void MainWindow::show_other_scan(const MesherOptions& mesher) {
  stop_picking();
  clear_distance();
  measured_.clear();
  surface_page_->evaluation().set_region(std::nullopt);
  surface_page_->evaluation().clear_result();
  surface_page_->set_options(mesher);
}

void MainWindow::show_mesher(const MesherOptions& mesher) {
  surface_page_->set_options(mesher);
}

void MainWindow::show_job(const std::optional<JobView>& job) {
  job_ = job;
  if (!job) return banner_->show_job(std::nullopt);
  banner_->show_job(std::make_pair(QString::fromStdString(job->title), job->share));
}

void MainWindow::choose_file() {
  // Not modal: the numbers behind it go on, and go blank when they must.
  auto* dialog = new QFileDialog(this, "Open a saved session (its session.toml) or a mesh file");
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setOption(QFileDialog::DontUseNativeDialog);
  dialog->setFileMode(QFileDialog::ExistingFile);
  dialog->setNameFilters({"Sessions and meshes (session.toml *.ply *.vtp *.stl *.obj)", "All files (*)"});
  connect(dialog, &QFileDialog::fileSelected, this,
          [this](const QString& file) { hooks_.open(file.toStdString()); });
  dialog->show();
}

void MainWindow::save_picture_now() {
  const QString file = QDateTime::currentDateTime().toString("'linescope-'yyyyMMdd-HHmmss'.png'");
  const auto saved = save_picture(file);
  show_notice({monotonic_now(), saved ? Notice::Kind::information : Notice::Kind::refusal,
               saved ? "Picture saved as " + file.toStdString() : saved.error().message});
}

Result<void> MainWindow::save_picture(const QString& file) {
  scene().request_picture();
  views_->draw_if_needed();
  if (grab().save(file)) return {};
  return fail(ErrorCode::unreadable,
              "picture " + file.toStdString() + " cannot be written: is the folder there and writable?");
}

std::vector<std::string> MainWindow::save_moments(const QString& folder) {
  const Moment moment_was = moment_;
  const Shown shown_was = surface_page_->shown();
  std::vector<std::string> files;
  for (const Moment moment : {Moment::scan, Moment::surface, Moment::navigate}) {
    enter(moment);
    show_texts(state_, shown_angle_, monotonic_now());
    const QString file = QString("%1/%2.png").arg(folder, name(moment));
    if (save_picture(file)) files.push_back(file.toStdString());
  }
  set_moment(moment_was);
  set_shown(shown_was);
  return files;
}

QString MainWindow::diagnostics_text() {
  if (diagnostics_ == nullptr) diagnostics_ = new DiagnosticsDialog(this);
  diagnostics_->show_state(state_, figures(), log_);
  return diagnostics_->as_text();
}

WindowPreferences MainWindow::preferences() const {
  WindowPreferences p;
  Scene& scene = views_->scene();
  p.layout = scene.layout();
  p.colour = surface_page_->colouring();
  p.smooth = surface_page_->smooth();
  p.flipped = scene.harvester_view_flipped();
  p.tolerance = navigate_page_->tolerance();
  p.sound = navigate_page_->sound();
  p.evaluation = surface_page_->evaluation().request();
  return p;
}

void MainWindow::set_preferences(const WindowPreferences& p) {
  scene().set_layout(p.layout);
  if (p.flipped != scene().harvester_view_flipped()) scene().flip_harvester_view();
  surface_page_->set_colouring(p.colour, p.smooth);
  surface_page_->evaluation().set_request(p.evaluation);
  navigate_page_->set_preferences(p.tolerance, p.sound);
}

}  // namespace linescope
