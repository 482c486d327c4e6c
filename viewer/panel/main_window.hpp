// The operator's window: assembles bars, views and pages, and shows one ViewState after the other. It
// computes nothing that takes time and waits for nobody.
#pragma once

#include <QElapsedTimer>
#include <QJsonObject>
#include <QMainWindow>
#include <functional>
#include <optional>

#include "ipc/control.hpp"
#include "viewer/navigation_worker.hpp"
#include "viewer/panel/operator_action.hpp"
#include "viewer/panel/pace.hpp"
#include "viewer/panel/surface_page.hpp"
#include "viewer/panel/top_bar.hpp"
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

/// What the window asks others to do; none of it waits.
struct WindowHooks {
  std::function<void(CommandKind)> command;
  std::function<void()> forget_scan;
  std::function<void(const MesherOptions&)> set_mesher;
  std::function<void(NormalChoice)> set_normal;
};

class MainWindow : public QMainWindow {
 public:
  MainWindow(WindowHooks hooks, const MesherOptions& mesher, NormalChoice normal);
  ~MainWindow() override;

  /// The newest of everything, and the lines since the last call.
  void show_state(const ViewState& state, const std::vector<LineNews>& news, Nanoseconds now);
  void show_notice(const Notice& notice);

  void act(OperatorAction action);
  void set_moment(Moment moment);
  Moment moment() const { return moment_; }
  Scene& scene();

  /// How late the tick that brought this state was.
  void note_lateness(double milliseconds) { late_.add(milliseconds); }

  /// The texts as shown (keys: docs/operators-guide.md).
  QJsonObject displayed_state() const;
  /// The window as a picture.
  Result<void> save_picture(const QString& file);

 private:
  void build();
  void resizeEvent(QResizeEvent* event) override;
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
  void set_shown(Shown shown);
  void move_view(OperatorAction action);
  void measure_click(int x, int y);
  void act_on_views(OperatorAction action);
  void act_on_surface(OperatorAction action);
  void act_on_window(OperatorAction action);

  WindowHooks hooks_;
  MesherOptions mesher_;
  NormalChoice normal_;
  Moment moment_ = Moment::scan;
  ViewState state_;
  AngleReadout shown_angle_;  ///< as last brought to the screen
  Nanoseconds shown_at_ = 0;
  ColourBy colour_ = ColourBy::plain;
  std::optional<Eigen::Vector3d> measure_from_;
  bool measuring_ = false;
  QStringList log_;
  PaceMeter late_, draw_;
  QElapsedTimer since_draw_;
  double last_draw_ms_ = 0;

  QWidget* side_ = nullptr;
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
