#include "viewer/panel/dialogs.hpp"

#include <fmt/format.h>

#include <QApplication>
#include <QClipboard>
#include <QHeaderView>
#include <QLabel>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QTabWidget>
#include <QTableWidget>
#include <QVBoxLayout>
#include <algorithm>

#include "common/version.hpp"
#include "viewer/panel/operator_action.hpp"
#include "viewer/panel/theme.hpp"
#include "viewer/readouts.hpp"

namespace linescope {
namespace {

QTableWidget* table(const QStringList& heads, QWidget* parent) {
  auto* made = new QTableWidget(0, heads.size(), parent);
  made->setHorizontalHeaderLabels(heads);
  made->verticalHeader()->hide();
  made->setEditTriggers(QAbstractItemView::NoEditTriggers);
  made->setSelectionMode(QAbstractItemView::NoSelection);
  made->horizontalHeader()->setSectionResizeMode(QHeaderView::Stretch);
  return made;
}

void put(QTableWidget& t, int row, const QStringList& texts) {
  for (int column = 0; column < texts.size(); ++column) {
    if (t.item(row, column) == nullptr) t.setItem(row, column, new QTableWidgetItem);
    if (t.item(row, column)->text() != texts[column]) t.item(row, column)->setText(texts[column]);
  }
}

QString ms(Nanoseconds t) {
  return QString::number(milliseconds_from(t), 'f', 2);
}

void set_text(QPlainTextEdit& edit, const QString& text) {
  if (edit.toPlainText() != text) edit.setPlainText(text);
}

std::string summary(const ViewState& state, const DisplayFigures& d) {
  const LiveView& live = *state.live;
  std::string text = fmt::format(
      "linescope-viewer {}  (not for clinical use)\nsegment   {}\ndaemon    {} pid {} session {:x}\n",
      kVersion, live.link.segment, live.link.daemon, live.link.pid, live.link.session);
  text += fmt::format(
      "graphics  {}\ndisplay   events wait {:.1f} / {:.1f} ms, drawing {:.1f} / {:.1f} ms (p50 / p95)\n",
      d.graphics, d.wait_p50_ms, d.wait_p95_ms, d.draw_p50_ms, d.draw_p95_ms);
  text += fmt::format("scan      {}\nsurface   {}, t = {} mm, {:.1f} ms, {} points refused\n",
                      scan_summary(live), state.surface->method, state.surface->interval,
                      milliseconds_from(state.surface->took), state.surface->points_refused);
  text += fmt::format("normal    {}\ncamera    {} {:.1f} Hz\n", state.navigation->method, live.camera.name,
                      live.camera.rate_hz);
  for (const ToolRole role : {ToolRole::endoscope, ToolRole::object, ToolRole::harvester}) {
    const StatusLine line = tool_status(live, role, live.time);
    text += fmt::format("{:<9} station {}, {} {}\n", line.title, live.tool(role).station + 1, line.word,
                        line.detail);
  }
  return text;
}

}  // namespace

ShortcutsDialog::ShortcutsDialog(QWidget* parent) : QDialog(parent) {
  setWindowTitle("Keys (also for foot pedals, which send keys)");
  auto* rows = new QVBoxLayout(this);
  auto* keys = table({"Key", "What it does"}, this);
  keys->horizontalHeader()->setSectionResizeMode(0, QHeaderView::ResizeToContents);
  for (const ActionInfo& i : operator_actions()) {
    keys->insertRow(keys->rowCount());
    put(*keys, keys->rowCount() - 1, {i.key, i.text});
  }
  rows->addWidget(keys);
  rows->addWidget(new QLabel(
      "Mouse: left turns, middle moves, wheel zooms. The axis views are moved, not turned.", this));
  resize(scaled(560), scaled(640));
}

DiagnosticsDialog::DiagnosticsDialog(QWidget* parent) : QDialog(parent) {
  setWindowTitle("Diagnostics");
  auto* rows = new QVBoxLayout(this);
  auto* tabs = new QTabWidget(this);
  summary_ = new QPlainTextEdit(this);
  log_ = new QPlainTextEdit(this);
  for (QPlainTextEdit* edit : {summary_, log_}) {
    edit->setReadOnly(true);
    edit->setStyleSheet("font-family: 'DejaVu Sans Mono', monospace;");
  }
  latencies_ = table({"Stage", "p50 ms", "p95 ms", "max ms", "count"}, this);
  counters_ = table({"Counter", "Value"}, this);
  tabs->addTab(summary_, "Summary");
  tabs->addTab(latencies_, "Latency");
  tabs->addTab(counters_, "Counters");
  tabs->addTab(log_, "Messages");
  rows->addWidget(tabs);
  auto* copy = new QPushButton("Copy diagnostics", this);
  copy->setToolTip("Everything on these pages as text, to attach to a report");
  connect(copy, &QPushButton::clicked, this, [this] { QApplication::clipboard()->setText(as_text()); });
  rows->addWidget(copy);
  resize(scaled(640), scaled(560));
}

void DiagnosticsDialog::show_state(const ViewState& state, const DisplayFigures& display,
                                   const QStringList& log) {
  set_text(*summary_, QString::fromStdString(summary(state, display)));
  set_text(*log_, log.join('\n'));
  std::vector<StageLatency> stages = display.stages;
  if (state.live->diagnostics)
    stages.insert(stages.begin(), state.live->diagnostics->latencies.begin(),
                  state.live->diagnostics->latencies.end());
  show_latencies(stages);
  if (!state.live->diagnostics) return;
  const DiagnosticsView& figures = *state.live->diagnostics;
  counters_->setRowCount(static_cast<int>(figures.counters.size()));
  for (int i = 0; i < counters_->rowCount(); ++i) {
    const NamedCount& c = figures.counters[static_cast<std::size_t>(i)];
    put(*counters_, i, {QString::fromStdString(c.name), QString::fromStdString(grouped(c.value))});
  }
}

void DiagnosticsDialog::show_latencies(const std::vector<StageLatency>& rows) {
  latencies_->setRowCount(static_cast<int>(rows.size()));
  for (int i = 0; i < latencies_->rowCount(); ++i) {
    const StageLatency& l = rows[static_cast<std::size_t>(i)];
    put(*latencies_, i,
        {QString::fromStdString(l.name), ms(l.p50), ms(l.p95), ms(l.max), QString::number(l.count)});
  }
}

QString DiagnosticsDialog::as_text() const {
  QString text = summary_->toPlainText();
  for (const QTableWidget* t : {latencies_, counters_}) {
    text += '\n';
    for (int row = 0; row < t->rowCount(); ++row) {
      for (int column = 0; column < t->columnCount(); ++column)
        text += (t->item(row, column) ? t->item(row, column)->text() : QString()) + '\t';
      text += '\n';
    }
  }
  return text + '\n' + log_->toPlainText() + '\n';
}

}  // namespace linescope
