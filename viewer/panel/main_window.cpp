#include "viewer/panel/main_window.hpp"

#include <fmt/format.h>
#include <vtkCamera.h>

#include <Eigen/Geometry>
#include <QShortcut>
#include <QStackedWidget>
#include <algorithm>

#include "common/units.hpp"
#include "viewer/navigate/angle_difference.hpp"
#include "viewer/panel/angle_display.hpp"
#include "viewer/panel/banner_bar.hpp"
#include "viewer/panel/dialogs.hpp"
#include "viewer/panel/navigate_page.hpp"
#include "viewer/panel/scan_page.hpp"
#include "viewer/panel/scene_widget.hpp"
#include "viewer/panel/view_strip.hpp"

namespace linescope {
namespace {

constexpr int kSideWidth = 348;
constexpr int kSideShare = 27, kViewsShare = 73;  ///< of the window's width
constexpr double kSmallNumerals = 44, kLargeNumerals = 94;
constexpr int kMessagesKept = 500;
constexpr double kLongDrawMs = 30;

}  // namespace

MainWindow::MainWindow(WindowHooks hooks, const MesherOptions& mesher, NormalChoice normal)
    : hooks_(std::move(hooks)), mesher_(mesher), normal_(normal), guidance_(guidance_options(tolerance_)) {
  setWindowTitle("linescope · not for clinical use");
  setStyleSheet(style_sheet(panel_scale()));
  build();
  add_keys();
  enter(Moment::scan);
  resize(1280, 720);
}

MainWindow::~MainWindow() = default;

Scene& MainWindow::scene() {
  return views_->scene();
}

void MainWindow::build() {
  auto* central = new QWidget(this);
  central->setObjectName("central");
  auto* rows = new QVBoxLayout(central);
  rows->setContentsMargins(0, 0, 0, 0);
  rows->setSpacing(0);
  top_ = new TopBar([this](OperatorAction action) { act(action); }, central);
  banner_ = new BannerBar([this] { act(OperatorAction::cancel); }, central);
  rows->addWidget(top_);
  rows->addWidget(banner_);
  auto* middle = new QHBoxLayout;
  middle->setContentsMargins(0, 0, scaled(10), 0);
  middle->setSpacing(scaled(10));
  middle->addWidget(build_views(), kViewsShare);
  middle->addWidget(build_side(), kSideShare);
  rows->addLayout(middle, 1);
  rows->addWidget(build_foot());
  setCentralWidget(central);
}

QWidget* MainWindow::build_views() {
  auto* box = new QWidget(this);
  auto* rows = new QVBoxLayout(box);
  rows->setContentsMargins(0, 0, 0, 0);
  rows->setSpacing(0);
  views_ = new SceneWidget(box);
  scene().mouse().clicked = [this](int x, int y) { clicked(x, y); };
  strip_ = new ViewStrip(
      {[this](const ViewPose& pose) { scene().follow_harvester(false), scene().set_view_pose(pose); },
       [this](NamedView view) { scene().follow_harvester(false), scene().look_from(view); },
       [this](OperatorAction action) { act(action); }},
      box);
  rows->addWidget(views_, 1);
  rows->addWidget(strip_);
  return box;
}

QWidget* MainWindow::build_side() {
  auto* side = new QWidget(this);
  // A larger window gives the picture and the bullseye their share.
  side->setMinimumWidth(scaled(kSideWidth));
  side->setMaximumWidth(scaled(1.6 * kSideWidth));
  auto* rows = new QVBoxLayout(side);
  rows->setContentsMargins(0, scaled(8), 0, scaled(8));
  rows->setSpacing(scaled(8));
  angle_ = new AngleDisplay(side);
  pages_ = new QStackedWidget(side);
  scan_page_ = new ScanPage(side);
  surface_page_ = new SurfacePage({[this](Shown shown) { set_shown(shown); },
                                   [this](const MesherOptions& options) { hooks_.set_mesher(options); },
                                   [this](bool on) { scene().surface().use_normals(on); },
                                   [this](ColourBy what) {
                                     colour_ = what;
                                     scene().surface().colour_by(what, scene().cloud().outward());
                                     scene().cloud().colour_by(what, scene().cloud().outward());
                                   },
                                   {[this] { act(OperatorAction::evaluate); },
                                    [this] { act(OperatorAction::region); }, [this] { mark_region(); }}},
                                  mesher_, side);
  navigate_page_ =
      new NavigatePage([this](NormalChoice choice) { hooks_.set_normal(choice); }, normal_, side);
  for (QWidget* page : {static_cast<QWidget*>(scan_page_), static_cast<QWidget*>(surface_page_),
                        static_cast<QWidget*>(navigate_page_)})
    pages_->addWidget(page);
  rows->addWidget(angle_);
  rows->addWidget(pages_, 1);
  return side;
}

QWidget* MainWindow::build_foot() {
  auto* foot = new QWidget(this);
  auto* row = new QHBoxLayout(foot);
  row->setContentsMargins(scaled(10), scaled(6), scaled(10), scaled(8));
  row->setSpacing(scaled(8));
  for (StatusCard*& card : cards_) row->addWidget(card = new StatusCard(foot), 1);
  return foot;
}

void MainWindow::add_keys() {
  for (const ActionInfo& i : operator_actions()) {
    auto* key = new QShortcut(QKeySequence(i.key), this);
    const OperatorAction action = i.action;
    connect(key, &QShortcut::activated, this, [this, action] { act(action); });
  }
}

void MainWindow::set_moment(Moment moment) {
  moment_ = moment;
  // The pages that are not shown ask for no room.
  for (int i = 0; i < pages_->count(); ++i) {
    const auto policy = i == static_cast<int>(moment) ? QSizePolicy::Preferred : QSizePolicy::Ignored;
    pages_->widget(i)->setSizePolicy(policy, policy);
  }
  pages_->setCurrentIndex(static_cast<int>(moment));
  angle_->set_numeral_size(moment == Moment::navigate ? kLargeNumerals : kSmallNumerals);
  angle_->setVisible(moment != Moment::surface);  // there the room belongs to figures of the surface
  top_->show_moment(moment);
  scene().request_picture();
}

/// A scan shows its points and, below them, the surface as it grows.
void MainWindow::enter(Moment moment) {
  set_moment(moment);
  set_shown(moment == Moment::scan ? Shown::points : Shown::surface);
  if (moment == Moment::scan) scene().surface().show(SurfaceStyle::surface);
}

void MainWindow::set_shown(Shown shown) {
  surface_page_->set_shown(shown);
  scene().cloud().show(shown == Shown::points);
  scene().surface().show_grid(shown == Shown::grid);
  scene().surface().show(shown == Shown::surface     ? SurfaceStyle::surface
                         : shown == Shown::wireframe ? SurfaceStyle::wireframe
                                                     : SurfaceStyle::hidden);
}

void MainWindow::show_state(const ViewState& state, const std::vector<LineNews>& news, Nanoseconds now) {
  const bool new_surface = state.surface != state_.surface;
  state_ = state;
  show_news(news);
  if (new_surface) show_surface(state);
  if (const Tolerance wanted = navigate_page_->tolerance(); wanted != tolerance_)
    guidance_ = Guidance(guidance_options(tolerance_ = wanted));
  const AngleReadout angle = angle_readout(state, now, guidance_);
  shown_angle_ = angle;
  shown_at_ = now;
  show_guidance(state, angle, now);
  show_texts(state, angle, now);
  note_shown(state, angle);
  // After a picture that took long, events and the daemon get their turn: at most a third of the time goes
  // into drawing.
  if (since_draw_.isValid() && static_cast<double>(since_draw_.elapsed()) < 2 * last_draw_ms_) return;
  QElapsedTimer took;
  took.start();
  if (!views_->draw_if_needed()) return;
  last_draw_ms_ = static_cast<double>(took.nsecsElapsed()) * 1e-6;
  draw_.add(last_draw_ms_);
  since_draw_.restart();
  if (last_draw_ms_ < kLongDrawMs) return;
  // The number was right before a picture that took long; it must still be when it is painted.
  const Nanoseconds later = monotonic_now();
  shown_angle_ = angle_readout(state, later, guidance_);
  shown_at_ = later;
  show_guidance(state, shown_angle_, later);
  angle_->show_angle(shown_angle_);
}

void MainWindow::show_news(const std::vector<LineNews>& news) {
  for (const LineNews& n : news) {
    if (n.forget) scene().cloud().clear();
    for (const auto& line : n.lines) scene().cloud().add(*line);
  }
}

void MainWindow::show_surface(const ViewState& state) {
  scene().surface().set(*state.surface);
  if (colour_ != ColourBy::plain) scene().surface().colour_by(colour_, scene().cloud().outward());
}

void MainWindow::show_guidance(const ViewState& state, const AngleReadout& angle, Nanoseconds now) {
  const LiveView& live = *state.live;
  GuidanceInput input;
  const auto harvester = last_known_harvester(live);
  if (harvester) {
    const bool good =
        tool_status(live, ToolRole::harvester, now).mood == Mood::good &&
        (live.held_in == HeldIn::world || tool_status(live, ToolRole::object, now).mood == Mood::good) &&
        live.link.state == LinkState::attached;
    input.harvester = good ? Presence::present : Presence::ghost;
    input.tip = harvester->tip;
    input.axis = harvester->axis;
  }
  input.normal = !angle.angle.blank();
  input.foot = state.navigation->foot;
  input.normal_direction = state.navigation->normal;
  input.on_target = angle.in_tolerance;
  scene().set_guidance(input);
  navigate_page_->show_state(angle, tilts(state, angle), *state.navigation);
}

std::optional<BullseyeReading> MainWindow::tilts(const ViewState& state, const AngleReadout& angle) const {
  if (angle.angle.blank()) return std::nullopt;
  vtkCamera& camera = *views_->scene().renderer(View::along_harvester).GetActiveCamera();
  Eigen::Vector3d up, out;
  camera.GetViewUp(up.data());
  camera.GetDirectionOfProjection(out.data());
  const auto parts = screen_tilts(state.navigation->normal, state.navigation->axis, out.cross(up), up);
  if (!parts) return std::nullopt;
  return BullseyeReading{degrees_from_radians(parts->right), degrees_from_radians(parts->up),
                         navigate_page_->tolerance().angle_deg};
}

std::string MainWindow::drawn_text() const {
  const CloudLayer& cloud = views_->scene().cloud();
  if (cloud.thinning() <= 1) return fmt::format("{} points", grouped(cloud.drawn()));
  return fmt::format("{} points, every {}th", grouped(cloud.drawn()), cloud.thinning());
}

void MainWindow::show_texts(const ViewState& state, const AngleReadout& angle, Nanoseconds now) {
  const LiveView& live = *state.live;
  const bool attached = live.link.state == LinkState::attached;
  angle_->show_angle(angle);
  top_->show_scanning(live.scan.scanning && attached, attached, live.link.state == LinkState::file);
  banner_->show_banner(banner(live, now), QString::fromStdString(scan_summary(live)));
  const StatusLine lines[] = {
      daemon_status(live, now), camera_status(live, now), tool_status(live, ToolRole::endoscope, now),
      tool_status(live, ToolRole::object, now), tool_status(live, ToolRole::harvester, now)};
  for (std::size_t i = 0; i < std::size(lines); ++i) cards_[i]->show_status(lines[i]);
  if (moment_ == Moment::scan) scan_page_->show_state(state, now);
  if (moment_ == Moment::surface) surface_page_->show_state(state, drawn_text());
  scene().set_note(live.held_in == HeldIn::object ? "object's frame (sensor 2)" : "tracker's frame");
  strip_->show_pose(scene().view_pose(), scene().layout(), scene().following(),
                    scene().harvester_view_flipped());
  if (diagnostics_ != nullptr && diagnostics_->isVisible()) diagnostics_->show_state(state, figures(), log_);
}

DisplayFigures MainWindow::figures() const {
  return {wait_.percentile(0.5),  wait_.percentile(0.95), draw_.percentile(0.5),
          draw_.percentile(0.95), views_->graphics(),     stages()};
}

void MainWindow::note_shown(const ViewState& state, const AngleReadout& angle) {
  const LiveView& live = *state.live;
  if (live.link.state != LinkState::attached) return;
  const Nanoseconds now = monotonic_now();
  if (!angle.angle.blank()) pose_shown_.shown(angle.pose_time, now);
  if (live.scan.newest.time > 0) line_shown_.shown(live.scan.newest.time, now);
  if (live.picture) picture_shown_.shown(live.picture->time, now);
}

std::vector<StageLatency> MainWindow::stages() const {
  const auto row = [](const char* name, const DisplayLatency& latency) {
    const LatencySummary s = latency.summary();
    return StageLatency{name, s.count, s.p50, s.p95, s.max};
  };
  return {row("tracker sample to screen", pose_shown_), row("laser line to screen", line_shown_),
          row("camera picture to screen", picture_shown_)};
}

void MainWindow::show_notice(const Notice& notice) {
  banner_->show_notice(notice);
  log_
      << QString("%1  %2").arg(seconds_from(notice.time), 0, 'f', 3).arg(QString::fromStdString(notice.text));
  while (log_.size() > kMessagesKept) log_.removeFirst();
}

}  // namespace linescope
