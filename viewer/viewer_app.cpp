#include "viewer/viewer_app.hpp"

#include <fmt/format.h>

#include <QApplication>
#include <algorithm>
#include <csignal>
#include <cstdio>

#include "viewer/panel/displayed_state.hpp"

namespace linescope {
namespace {

constexpr int kTickMs = 33;
constexpr Nanoseconds kStateEvery = 100 * kMillisecond;

volatile std::sig_atomic_t stop_requested = 0;
void request_stop(int) {
  stop_requested = 1;
}

}  // namespace

ViewerApp::ViewerApp(const ViewerOptions& options, std::vector<Step> script)
    : options_(options),
      window_(
          {.command =
               [this](CommandKind kind) { feed_->courier().order({.kind = kind, .number = 0, .text = {}}); },
           .forget_scan = [this] { feed_->forget_scan(); },
           .set_mesher = [this](const MesherOptions& mesher) { mesher_->set_options(mesher); },
           .set_normal = [this](NormalChoice choice) { navigator_->set_choice(choice); }},
          options.mesher, options.normal) {
  if (!script.empty()) script_.emplace(std::move(script), options.pictures, window_);
  window_.resize(options.width, options.height);
  mesher_ = std::make_unique<SurfaceWorker>(
      options.mesher, [this](std::shared_ptr<const SurfaceView> view) { surface_.put(std::move(view)); });
  navigator_ = std::make_unique<NavigationWorker>(
      options.normal,
      [this](std::shared_ptr<const NavigationView> view) { navigation_.put(std::move(view)); });
  feed_ =
      std::make_unique<SegmentFeed>(options.feed, FeedSinks{.live =
                                                                [this](std::shared_ptr<const LiveView> view) {
                                                                  navigator_->set_poses(view);
                                                                  live_.put(std::move(view));
                                                                },
                                                            .lines =
                                                                [this](const LineNews& news) {
                                                                  mesher_->add(news);
                                                                  navigator_->add(news);
                                                                  news_.put(news);
                                                                }});
}

ViewerApp::~ViewerApp() {
  feed_.reset();  // first: it feeds the other two
}

ExitCode ViewerApp::run() {
  std::signal(SIGTERM, request_stop);
  std::signal(SIGINT, request_stop);
  started_ = monotonic_now();
  timer_.setTimerType(Qt::PreciseTimer);
  QObject::connect(&timer_, &QTimer::timeout, [this] { tick(); });
  window_.show();
  since_tick_.start();
  timer_.start(kTickMs);
  QApplication::exec();
  timer_.stop();
  if (!options_.state_json.empty()) next_state_ = 0, write_state(monotonic_now());
  return exit_;
}

void ViewerApp::tick() {
  window_.note_lateness(std::max(0.0, static_cast<double>(since_tick_.nsecsElapsed()) * 1e-6 - kTickMs));
  since_tick_.restart();
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
  for (const Notice& notice : feed_->courier().take_notices()) window_.show_notice(notice);
  window_.show_state({live_.get(), surface_.get(), navigation_.get()}, news_.take(), monotonic_now());
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
