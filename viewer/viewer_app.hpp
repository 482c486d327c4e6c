// The process: starts the threads, brings their newest results to the window at every display tick, ends in
// order. Shows either what a daemon measures or a file: then there is no feed at all.
#pragma once

#include <QTimer>
#include <memory>
#include <optional>

#include "viewer/latest.hpp"
#include "viewer/navigation_worker.hpp"
#include "viewer/panel/main_window.hpp"
#include "viewer/script_runner.hpp"
#include "viewer/segment_feed.hpp"
#include "viewer/session_desk.hpp"
#include "viewer/surface_worker.hpp"
#include "viewer/viewer_options.hpp"

namespace linescope {

class ViewerApp {
 public:
  /// Needs a QApplication.
  ViewerApp(const ViewerOptions& options, std::vector<Step> script, const WindowPreferences& preferences);
  ~ViewerApp();

  /// Runs until the window is closed, the time is over, the script has ended or a signal came.
  ExitCode run();

  /// What the window looks like at the end, to be remembered.
  WindowPreferences preferences() const { return window_.preferences(); }
  const ViewerOptions& options() const { return options_; }

 private:
  WindowHooks window_hooks();
  void start_workers();
  void start_feed();
  void show_file(const Session& session);
  void go_live();
  void change_mesher(const MesherOptions& mesher);
  void cancel();
  std::optional<JobView> job(Nanoseconds now);
  void save_session(const std::string& folder);
  void tick();
  /// A thread's work: events of its own, to see how long the operator's wait.
  void probe_events(const std::stop_token& stop);
  void gather();
  void write_state(Nanoseconds now);
  void finish(ExitCode code, const std::string& why = {});
  void leave_a_picture();

  ViewerOptions options_;
  Latest<LiveView> live_;
  Latest<SurfaceView> surface_;
  Latest<NavigationView> navigation_;
  Inbox<LineNews> news_;
  SessionDesk desk_;
  MainWindow window_;
  std::optional<ScriptRunner> script_;
  QTimer timer_;
  Nanoseconds started_ = 0, next_state_ = 0;
  ExitCode exit_ = ExitCode::ok;

  /// A file's surface is shown: what the mesher says is not.
  std::atomic<bool> mesh_of_file_{false};
  MesherOptions mesher_before_;              ///< the last change of them
  Nanoseconds changing_since_ = 0;           ///< the surface is being made otherwise; 0: it is not
  std::optional<Result<void>> file_result_;  ///< of the last save or load; nothing while it goes on

  // The threads end before what they write to.
  std::unique_ptr<SurfaceWorker> mesher_;
  std::unique_ptr<NavigationWorker> navigator_;
  std::unique_ptr<SegmentFeed> feed_;
};

}  // namespace linescope
