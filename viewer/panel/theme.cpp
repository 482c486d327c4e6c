#include "viewer/panel/theme.hpp"

#include <cmath>

namespace linescope {
namespace {

double& the_scale() {
  static double scale = 1;  // one display, one scale; set before the first widget is made
  return scale;
}

// @N is N pixels at scale 1.
const char* const kSheet = R"(
QWidget { font-family: "DejaVu Sans", "Noto Sans", sans-serif; font-size: @13px; }
QMainWindow, QDialog, QWidget#central, QWidget#page, QScrollArea { background: #12171c; border: none; }
QToolTip { background: #28323b; color: #d7dde3; border: 1px solid #465460; padding: @4px; }
QLabel { background: transparent; }
QLabel#quiet { color: #96a2ad; font-size: @12px; }
QLabel#head { color: #96a2ad; font-size: @11px; font-weight: bold; }
QLabel#value { font-size: @16px; }
QLabel#disclaimer { color: #12171c; background: #e69f00; border-radius: @3px; padding: @3px @9px; font-weight: bold; }
QFrame#card, QFrame#box { background: #1a2128; border: 1px solid #2a343d; border-radius: @4px; }
QPushButton { background: #28323b; border: 1px solid #3a4650; border-radius: @4px; padding: @5px @10px; min-height: @18px; }
QPushButton:hover { background: #33404b; border-color: #56656f; }
QPushButton:focus { border-color: #56b4e9; }
QPushButton:pressed { background: #1f272e; }
QPushButton:checked { background: #1d5f86; border-color: #56b4e9; color: #ffffff; }
QPushButton:disabled { color: #5d6871; background: #1a2128; }
QPushButton#action { font-size: @15px; font-weight: bold; padding: @8px @18px; min-width: @66px; }
QPushButton#small { padding: @3px @8px; min-height: @16px; }
QPlainTextEdit, QTableWidget, QTextBrowser { background: #0e1216; border: 1px solid #2a343d; gridline-color: #2a343d; }
QHeaderView::section { background: #1a2128; border: none; padding: @4px; color: #96a2ad; }
QTabBar::tab { background: #1a2128; padding: @6px @14px; border: 1px solid #2a343d; }
QTabBar::tab:selected { background: #28323b; }
QTabWidget::pane { border: 1px solid #2a343d; }
QProgressBar { background: #0e1216; border: 1px solid #3a4650; border-radius: @3px; text-align: center; }
QProgressBar::chunk { background: #1d5f86; }
QScrollBar:vertical { background: #12171c; width: @10px; }
QScrollBar::handle:vertical { background: #3a4650; border-radius: @4px; min-height: @24px; }
QScrollBar::add-line, QScrollBar::sub-line { height: 0; width: 0; }
)";

}  // namespace

QColor colour(const Rgb& rgb) {
  return QColor::fromRgbF(rgb[0], rgb[1], rgb[2]);
}

QColor colour(Mood mood) {
  switch (mood) {
    case Mood::good:
      return colour(palette::kOnTarget);
    case Mood::caution:
      return colour(palette::of(0xe69f00));
    case Mood::bad:
      return colour(palette::of(0xff7b4f));
    case Mood::off:
      break;
  }
  return colour(palette::kQuiet);
}

QString mark(Mood mood) {
  switch (mood) {
    case Mood::good:
      return QStringLiteral("●");
    case Mood::caution:
      return QStringLiteral("▲");
    case Mood::bad:
      return QStringLiteral("✕");
    case Mood::off:
      break;
  }
  return QStringLiteral("○");
}

void set_panel_scale(double scale) {
  the_scale() = scale;
}
double panel_scale() {
  return the_scale();
}
QPalette dark_palette() {
  QPalette p;
  const QColor ground("#12171c"), field("#0e1216"), control("#28323b"), text("#d7dde3"), faint("#5d6871");
  p.setColor(QPalette::Window, ground);
  p.setColor(QPalette::Base, field);
  p.setColor(QPalette::AlternateBase, ground);
  p.setColor(QPalette::Button, control);
  p.setColor(QPalette::ToolTipBase, control);
  for (const auto role : {QPalette::WindowText, QPalette::Text, QPalette::ButtonText, QPalette::ToolTipText})
    p.setColor(role, text);
  for (const auto role : {QPalette::WindowText, QPalette::Text, QPalette::ButtonText})
    p.setColor(QPalette::Disabled, role, faint);
  p.setColor(QPalette::Highlight, QColor("#1d5f86"));
  p.setColor(QPalette::HighlightedText, Qt::white);
  return p;
}

int scaled(double pixels) {
  return static_cast<int>(std::lround(pixels * the_scale()));
}

QString style_sheet(double scale) {
  QString sheet;
  const QString source = QString::fromUtf8(kSheet);
  for (int i = 0; i < source.size(); ++i) {
    if (source[i] != '@') {
      sheet += source[i];
      continue;
    }
    int number = 0;
    while (source[i + 1].isDigit()) number = 10 * number + source[++i].digitValue();
    sheet += QString::number(std::max(1, static_cast<int>(std::lround(number * scale))));
  }
  return sheet;
}

}  // namespace linescope
