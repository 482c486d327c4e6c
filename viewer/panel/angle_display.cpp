#include "viewer/panel/angle_display.hpp"

#include <QPainter>

#include "viewer/panel/theme.hpp"

namespace linescope {
namespace {

// Digits that change more often than this cannot be read; going blank or coming back is never held up.
constexpr qint64 kHoldDigitsMs = 100;

}  // namespace

AngleDisplay::AngleDisplay(QWidget* parent) : QFrame(parent) {
  setObjectName("box");
  setToolTip("AngDif: angle between the harvester's axis and the surface normal");
  set_numeral_size(numeral_size_);
  show_angle({});
}

void AngleDisplay::set_numeral_size(double pixels) {
  numeral_size_ = pixels;
  setFixedHeight(scaled(pixels * 1.15 + 62));
  update();
}

int AngleDisplay::fitting_size(QFont font, int width) const {
  const int wanted = scaled(numeral_size_);
  font.setPixelSize(wanted);
  const int needed = QFontMetrics(font).horizontalAdvance(shown_);
  return needed <= width ? wanted : wanted * width / needed;
}

void AngleDisplay::show_angle(const AngleReadout& readout) {
  const QString text = QString::fromStdString(readout.angle.text);
  const bool edge = readout.angle.blank() != (shown_ == kBlank);
  if (!edge && changed_.isValid() && changed_.elapsed() < kHoldDigitsMs) return;
  const QString reason = QString::fromStdString(readout.angle.reason);
  const QString interval =
      QString::fromStdString(readout.interval.blank() ? "" : "95 %:  " + readout.interval.text);
  pose_time_ = readout.pose_time;
  if (text == shown_ && reason == reason_ && interval == interval_ && in_tolerance_ == readout.in_tolerance)
    return;
  shown_ = text;
  reason_ = reason;
  interval_ = interval;
  in_tolerance_ = readout.in_tolerance;
  changed_.restart();
  update();
}

void AngleDisplay::paintEvent(QPaintEvent* event) {
  QFrame::paintEvent(event);
  QPainter painter(this);
  const bool blank = shown_ == kBlank;
  const QRect inner = rect().adjusted(scaled(12), scaled(8), -scaled(12), -scaled(8));
  QFont font = painter.font();
  font.setPixelSize(scaled(13));
  font.setBold(true);
  painter.setFont(font);
  painter.setPen(colour(palette::kQuiet).lighter(120));
  painter.drawText(inner, Qt::AlignLeft | Qt::AlignTop, "AngDif");
  if (in_tolerance_ && !blank) {
    painter.setPen(colour(Mood::good));
    painter.drawText(inner, Qt::AlignRight | Qt::AlignTop, mark(Mood::good) + " within tolerance");
  }
  font.setPixelSize(fitting_size(font, inner.width()));
  painter.setFont(font);
  painter.setPen(blank ? colour(palette::kQuiet) : in_tolerance_ ? colour(Mood::good) : QColor(Qt::white));
  painter.drawText(inner.adjusted(0, scaled(14), 0, -scaled(22)), Qt::AlignCenter,
                   blank ? QStringLiteral("– –") : shown_);
  font.setPixelSize(scaled(13));
  font.setBold(false);
  painter.setFont(font);
  painter.setPen(blank ? colour(Mood::caution) : colour(palette::kText));
  const QRect foot = inner.adjusted(0, inner.height() - scaled(34), 0, 0);
  const QString under = blank ? reason_ : interval_;
  painter.drawText(foot, Qt::AlignHCenter | Qt::AlignBottom | Qt::TextWordWrap, under);
}

}  // namespace linescope
