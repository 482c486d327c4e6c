// The process: starts the threads, brings their newest results to the window at every display tick, ends in
// order.
#pragma once

#include <QElapsedTimer>
#include <QTimer>
#include <memory>
#include <optional>

#include "viewer/latest.hpp"
#include "viewer/navigation_worker.hpp"
#include "viewer/panel/main_window.hpp"
#include "viewer/script_runner.hpp"
#include "viewer/segment_feed.hpp"
#include "viewer/surface_worker.hpp"
#include "viewer/viewer_options.hpp"

namespace linescope {

class ViewerApp {
 public:
  /// Needs a QApplication.
  ViewerApp(const ViewerOptions& options, std::vector<Step> script);
  ~ViewerApp();

  /// Runs until the window is closed, the time is over, the script has ended or a signal came.
  ExitCode run();

 private:
  void tick();
  void gather();
  void write_state(Nanoseconds now);
  void finish(ExitCode code, const std::string& why = {});
  void leave_a_picture();

  ViewerOptions options_;
  Latest<LiveView> live_;
  Latest<SurfaceView> surface_;
  Latest<NavigationView> navigation_;
  Inbox<LineNews> news_;
  MainWindow window_;
  std::optional<ScriptRunner> script_;
  QTimer timer_;
  QElapsedTimer since_tick_;
  Nanoseconds started_ = 0, next_state_ = 0;
  ExitCode exit_ = ExitCode::ok;

  // The threads end before what they write to.
  std::unique_ptr<SurfaceWorker> mesher_;
  std::unique_ptr<NavigationWorker> navigator_;
  std::unique_ptr<SegmentFeed> feed_;
};

}  // namespace linescope
