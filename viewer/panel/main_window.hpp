// The operator's window: assembles bars, views and pages, and shows one ViewState after the other. It
// computes nothing that takes time and waits for nobody.
#pragma once

#include <QElapsedTimer>
#include <QJsonObject>
#include <QMainWindow>
#include <functional>
#include <optional>

#include "ipc/control.hpp"
#include "viewer/navigate/display_latency.hpp"
#include "viewer/navigation_worker.hpp"
#include "viewer/panel/operator_action.hpp"
#include "viewer/panel/pace.hpp"
#include "viewer/panel/surface_page.hpp"
#include "viewer/panel/top_bar.hpp"
#include "viewer/panel/window_preferences.hpp"
#include "viewer/readouts.hpp"
#include "viewer/scene/scene.hpp"

class QStackedWidget;

namespace linescope {

class AngleDisplay;
class BannerBar;
class DiagnosticsDialog;
class NavigatePage;
class ScanPage;
class SceneWidget;
class ShortcutsDialog;
class StatusCard;
class ViewStrip;
struct BullseyeReading;
struct DisplayFigures;

/// What the window asks others to do; none of it waits.
struct WindowHooks {
  std::function<void(CommandKind)> command;
  std::function<void()> forget_scan;
  std::function<void(const MesherOptions&)> set_mesher;
  std::function<void(NormalChoice)> set_normal;
  std::function<void()> save_session;
  std::function<void(const std::string& path)> open;
  std::function<void()> go_live;  ///< leave the file that is shown
  std::function<void(const EvaluationRequest&)> evaluate;
  std::function<void()> cancel;  ///< the longer work that is being done
};

/// Longer work, as the window shows it.
struct JobView {
  std::string title;
  double share = 0;  ///< 0..1
};

class MainWindow : public QMainWindow {
 public:
  MainWindow(WindowHooks hooks, const MesherOptions& mesher, NormalChoice normal);
  ~MainWindow() override;

  /// The newest of everything, and the lines since the last call.
  void show_state(const ViewState& state, const std::vector<LineNews>& news, Nanoseconds now);
  void show_notice(const Notice& notice);
  void show_job(const std::optional<JobView>& job);
  void show_evaluation(const Result<ShapeEvaluation>& result);
  /// The surface is another one, made with these options: marks and results of the former one go.
  void show_other_scan(const MesherOptions& mesher);

  /// How the surface is made after all.
  void show_mesher(const MesherOptions& mesher);

  WindowPreferences preferences() const;
  void set_preferences(const WindowPreferences& preferences);

  void act(OperatorAction action);
  void set_moment(Moment moment);
  Moment moment() const { return moment_; }
  Scene& scene();

  /// How long an event, such as a key, waited for its turn.
  void note_event_wait(double milliseconds) { wait_.add(milliseconds); }

  /// The texts as shown (keys: docs/operators-guide.md).
  QJsonObject displayed_state() const;
  /// The window as a picture.
  Result<void> save_picture(const QString& file);
  /// The same in each of the three moments: scan.png, surface.png, navigate.png in `folder`.
  std::vector<std::string> save_moments(const QString& folder);
  QString diagnostics_text();
  /// Distances the operator measured on this scan, mm.
  const std::vector<double>& measured() const { return measured_; }

 private:
  void build();
  QWidget* build_side();
  QWidget* build_views();
  QWidget* build_foot();
  void add_keys();

  void show_news(const std::vector<LineNews>& news);
  void show_surface(const ViewState& state);
  void show_guidance(const ViewState& state, const AngleReadout& angle, Nanoseconds now);
  void show_texts(const ViewState& state, const AngleReadout& angle, Nanoseconds now);
  std::optional<BullseyeReading> tilts(const ViewState& state, const AngleReadout& angle) const;
  std::string drawn_text() const;

  void scan_or_stop();
  void clear();
  /// The moment with what it shows at first; keys then change what is shown.
  void enter(Moment moment);
  void set_shown(Shown shown);
  void move_view(OperatorAction action);
  void clicked(int x, int y);
  void measure_click(const Eigen::Vector3d& point);
  void pick_region();
  void mark_region();
  void stop_picking();
  void clear_distance();
  void choose_file();
  void save_picture_now();
  std::vector<StageLatency> stages() const;
  DisplayFigures figures() const;
  void note_shown(const ViewState& state, const AngleReadout& angle);
  void act_on_files(OperatorAction action);
  void act_on_views(OperatorAction action);
  void act_on_surface(OperatorAction action);
  void act_on_window(OperatorAction action);

  WindowHooks hooks_;
  MesherOptions mesher_;
  NormalChoice normal_;
  Moment moment_ = Moment::scan;
  ViewState state_;
  Tolerance tolerance_;  ///< of the guidance
  Guidance guidance_;
  AngleReadout shown_angle_;  ///< as last brought to the screen
  Nanoseconds shown_at_ = 0;
  ColourBy colour_ = ColourBy::plain;
  enum class Picking : std::uint8_t { nothing, distance, region };
  Picking picking_ = Picking::nothing;
  std::vector<Eigen::Vector3d> ends_;  ///< of the distance being measured
  std::vector<double> measured_;
  std::optional<JobView> job_;
  QStringList log_;
  PaceMeter wait_, draw_;
  DisplayLatency pose_shown_, line_shown_, picture_shown_;
  QElapsedTimer since_draw_;
  double last_draw_ms_ = 0;

  TopBar* top_ = nullptr;
  BannerBar* banner_ = nullptr;
  SceneWidget* views_ = nullptr;
  ViewStrip* strip_ = nullptr;
  AngleDisplay* angle_ = nullptr;
  QStackedWidget* pages_ = nullptr;
  ScanPage* scan_page_ = nullptr;
  SurfacePage* surface_page_ = nullptr;
  NavigatePage* navigate_page_ = nullptr;
  StatusCard* cards_[5] = {};
  DiagnosticsDialog* diagnostics_ = nullptr;
  ShortcutsDialog* shortcuts_ = nullptr;
};

}  // namespace linescope
