#include "viewer/viewer_app.hpp"

#include <fmt/format.h>

#include <QApplication>
#include <QDateTime>
#include <QTemporaryDir>
#include <chrono>
#include <csignal>
#include <cstdio>

#include "common/version.hpp"
#include "viewer/panel/displayed_state.hpp"

namespace linescope {
namespace {

constexpr int kTickMs = 33;
constexpr Nanoseconds kStateEvery = 100 * kMillisecond;
constexpr Nanoseconds kShowJobAfter = 300 * kMillisecond;
constexpr auto kProbeEvery = std::chrono::milliseconds(20);

volatile std::sig_atomic_t stop_requested = 0;
void request_stop(int) {
  stop_requested = 1;
}

std::shared_ptr<const SurfaceView> surface_of(const Session& session) {
  auto view = std::make_shared<SurfaceView>();
  view->mesh = session.mesh ? session.mesh : std::make_shared<const TriangleMesh>();
  view->method = session.method;
  view->interval = session.mesher.interval;
  view->lines = session.lines.size();
  view->points = session.point_count();
  view->filled = view->mesh->filled_count();
  view->area = view->seen_area = view->mesh->area();
  return view;
}

LiveView view_of_file(const Session& session) {
  LiveView view;
  view.time = monotonic_now();
  view.held_in = session.held_in;
  view.link.state = LinkState::file;
  view.link.text = "File " + session.name + (session.saved.empty() ? "" : ", saved " + session.saved);
  view.link.daemon = session.daemon;
  view.scan.lines = session.lines.size();
  view.scan.points = session.point_count();
  return view;
}

}  // namespace

WindowHooks ViewerApp::window_hooks() {
  return {
      .command =
          [this](CommandKind kind) {
            if (feed_) feed_->courier().order({.kind = kind, .number = 0, .text = {}});
          },
      .forget_scan =
          [this] {
            if (feed_) feed_->forget_scan();
          },
      .set_mesher = [this](const MesherOptions& mesher) { change_mesher(mesher); },
      .set_normal =
          [this](NormalChoice choice) {
            options_.normal = choice;
            navigator_->set_choice(choice);
          },
      .save_session =
          [this] {
            const QString name = QDateTime::currentDateTime().toString("'linescope-session-'yyyyMMdd-HHmmss");
            save_session(options_.sessions + "/" + name.toStdString());
          },
      .open = [this](const std::string& path) { desk_.load(path); },
      .go_live = [this] { go_live(); },
      .evaluate = [this](const EvaluationRequest& request) { desk_.evaluate(request, surface_.get()->mesh); },
      .cancel = [this] { cancel(); }};
}

ViewerApp::ViewerApp(const ViewerOptions& options, std::vector<Step> script,
                     const WindowPreferences& preferences)
    : options_(options),
      desk_({.tell = [this](const Notice& notice) { window_.show_notice(notice); },
             .show = [this](const Session& session) { show_file(session); },
             .evaluated = [this](const Result<ShapeEvaluation>& result) { window_.show_evaluation(result); },
             .finished = [this](const Result<void>& result) { file_result_ = result; }}),
      window_(window_hooks(), options.mesher, options.normal) {
  if (!script.empty())
    script_.emplace(
        std::move(script), options.pictures, window_,
        ScriptFiles{.load = [this](const std::string& path) { file_result_.reset(), desk_.load(path); },
                    .save = [this](const std::string& folder) { save_session(folder); },
                    .result = [this] { return file_result_; }});
  window_.resize(options.width, options.height);
  window_.set_preferences(preferences);
  start_workers();
  if (options.load.empty())
    start_feed();
  else
    desk_.load(options.load);
}

ViewerApp::~ViewerApp() {
  feed_.reset();  // first: it feeds the other two
}

void ViewerApp::start_workers() {
  mesher_ = std::make_unique<SurfaceWorker>(options_.mesher, [this](std::shared_ptr<const SurfaceView> view) {
    if (!mesh_of_file_) surface_.put(std::move(view));
  });
  navigator_ = std::make_unique<NavigationWorker>(
      options_.normal,
      [this](std::shared_ptr<const NavigationView> view) { navigation_.put(std::move(view)); });
}

void ViewerApp::start_feed() {
  const auto take_live = [this](std::shared_ptr<const LiveView> view) {
    navigator_->set_poses(view);
    live_.put(std::move(view));
  };
  const auto take_lines = [this](const LineNews& news) {
    mesher_->add(news);
    navigator_->add(news);
    news_.put(news);
  };
  feed_ = std::make_unique<SegmentFeed>(options_.feed, FeedSinks{.live = take_live, .lines = take_lines});
}

void ViewerApp::show_file(const Session& session) {
  feed_.reset();
  mesh_of_file_ = session.mesh != nullptr;
  const LineNews news{.forget = true, .lines = session.lines};
  news_.put(news);
  navigator_->add(news);
  // The surface is the one that was saved; it is made anew when the operator asks for another.
  mesher_->set_options(session.mesher);
  mesher_->add(mesh_of_file_ ? LineNews{.forget = true, .lines = {}} : news);
  surface_.put(surface_of(session));
  const auto live = std::make_shared<const LiveView>(view_of_file(session));
  navigator_->set_poses(live);
  live_.put(live);
  window_.show_other_scan(session.mesher);
}

void ViewerApp::go_live() {
  if (feed_) return;
  const LineNews forget{.forget = true, .lines = {}};
  mesh_of_file_ = false;
  surface_.put(std::make_shared<const SurfaceView>());
  mesher_->add(forget);
  navigator_->add(forget);
  news_.put(forget);
  window_.show_other_scan(options_.mesher);
  mesher_->set_options(options_.mesher);
  start_feed();
}

void ViewerApp::change_mesher(const MesherOptions& mesher) {
  if (mesh_of_file_ && desk_.lines().empty()) {
    window_.show_notice({monotonic_now(), Notice::Kind::refusal,
                         "A mesh file has no points to make another surface from; it stays as it is."});
    return;
  }
  mesher_before_ = std::exchange(options_.mesher, mesher);
  if (mesh_of_file_.exchange(false)) mesher_->add({.forget = true, .lines = desk_.lines()});
  mesher_->set_options(mesher);
}

void ViewerApp::cancel() {
  desk_.cancel();
  if (!mesher_->changing()) return;
  mesher_->give_up_change();
  options_.mesher = mesher_before_;
  window_.show_mesher(mesher_before_);
}

std::optional<JobView> ViewerApp::job(Nanoseconds now) {
  const auto share = mesher_->changing();
  if (!share) changing_since_ = 0;
  if (share && changing_since_ == 0) changing_since_ = now;
  if (const auto of_desk = desk_.job(now)) return of_desk;
  if (!share || now - changing_since_ < kShowJobAfter) return std::nullopt;
  return JobView{"Making the surface", *share};
}

void ViewerApp::save_session(const std::string& folder) {
  file_result_.reset();
  const auto live = live_.get();
  const auto surface = surface_.get();
  const auto text = [](const std::shared_ptr<const std::string>& t) { return t ? *t : std::string(); };
  Session session;
  session.saved = QDateTime::currentDateTime().toString(Qt::ISODate).toStdString();
  session.program = fmt::format("linescope-viewer {}", kVersion);
  session.held_in = live->held_in;
  session.mesh = surface->mesh;
  session.mesher = options_.mesher;
  session.mesher.interval = surface->interval > 0 ? surface->interval : options_.mesher.interval;
  session.method = surface->method;
  session.distances = window_.measured();
  session.daemon = live->link.daemon;
  session.configuration = text(live->configuration_text);
  session.calibration = text(live->calibration_text);
  session.diagnostics = window_.diagnostics_text().toStdString();
  const auto pictures = std::make_shared<QTemporaryDir>();
  std::vector<std::filesystem::path> files;
  for (const std::string& file : window_.save_moments(pictures->path())) files.emplace_back(file);
  desk_.save(std::move(session), folder, std::move(files), [pictures] {});
}

ExitCode ViewerApp::run() {
  std::signal(SIGTERM, request_stop);
  std::signal(SIGINT, request_stop);
  started_ = monotonic_now();
  timer_.setTimerType(Qt::PreciseTimer);
  QObject::connect(&timer_, &QTimer::timeout, [this] { tick(); });
  window_.show();
  timer_.start(kTickMs);
  std::jthread probe([this](const std::stop_token& stop) { probe_events(stop); });
  QApplication::exec();
  timer_.stop();
  options_.width = window_.width();
  options_.height = window_.height();
  if (!options_.state_json.empty()) next_state_ = 0, write_state(monotonic_now());
  return exit_;
}

void ViewerApp::probe_events(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    const Nanoseconds sent = monotonic_now();
    QMetaObject::invokeMethod(
        &timer_, [this, sent] { window_.note_event_wait(milliseconds_from(monotonic_now() - sent)); },
        Qt::QueuedConnection);
    std::this_thread::sleep_for(kProbeEvery);
  }
}

void ViewerApp::tick() {
  const Nanoseconds now = monotonic_now();
  gather();
  if (!options_.state_json.empty()) write_state(now);
  if (stop_requested != 0) return finish(ExitCode::ok);
  if (options_.quit_after_s > 0 && seconds_from(now - started_) >= options_.quit_after_s)
    return finish(ExitCode::ok);
  if (!script_) return;
  const auto progress = script_->advance(now);
  if (progress == ScriptRunner::Progress::done) finish(ExitCode::ok);
  if (progress == ScriptRunner::Progress::failed) finish(ExitCode::failed, script_->fault());
}

void ViewerApp::gather() {
  desk_.poll();
  if (feed_)
    for (const Notice& notice : feed_->courier().take_notices()) window_.show_notice(notice);
  const std::vector<LineNews> news = news_.take();
  desk_.note(news);
  window_.show_job(job(monotonic_now()));
  window_.show_state({live_.get(), surface_.get(), navigation_.get()}, news, monotonic_now());
}

void ViewerApp::write_state(Nanoseconds now) {
  if (now < next_state_) return;
  next_state_ = now + kStateEvery;
  const auto written =
      write_displayed_state(window_.displayed_state(), QString::fromStdString(options_.state_json));
  if (!written) finish(ExitCode::failed, written.error().message);
}

void ViewerApp::leave_a_picture() {
  if (options_.screenshot.empty()) return;
  const auto saved = window_.save_picture(QString::fromStdString(options_.screenshot));
  if (saved) return;
  exit_ = ExitCode::failed;
  fmt::print(stderr, "linescope-viewer: {}\n", saved.error().message);
}

void ViewerApp::finish(ExitCode code, const std::string& why) {
  if (!timer_.isActive()) return;
  timer_.stop();
  exit_ = code;
  if (!why.empty()) fmt::print(stderr, "linescope-viewer: {}\n", why);
  leave_a_picture();
  QApplication::quit();
}

}  // namespace linescope
