// The two windows beside the main one: the list of keys, and the diagnostics.
#pragma once

#include <QDialog>
#include <QStringList>

#include "viewer/view_state.hpp"

class QPlainTextEdit;
class QTableWidget;

namespace linescope {

class ShortcutsDialog : public QDialog {
 public:
  explicit ShortcutsDialog(QWidget* parent);
};

/// What the display itself knows of its own pace.
struct DisplayFigures {
  double wait_p50_ms = 0, wait_p95_ms = 0;  ///< how long an event waits for its turn
  double draw_p50_ms = 0, draw_p95_ms = 0;  ///< to draw the scene
  std::string graphics;
  std::vector<StageLatency> stages;  ///< from the outside world to the screen
};

class DiagnosticsDialog : public QDialog {
 public:
  explicit DiagnosticsDialog(QWidget* parent);
  void show_state(const ViewState& state, const DisplayFigures& display, const QStringList& log);
  /// All pages.
  QString as_text() const;

 private:
  void show_latencies(const std::vector<StageLatency>& rows);

  QTableWidget *latencies_, *counters_;
  QPlainTextEdit *summary_, *log_;
};

}  // namespace linescope
