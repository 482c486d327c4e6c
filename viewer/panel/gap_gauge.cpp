#include "viewer/panel/gap_gauge.hpp"

#include <QPainter>
#include <algorithm>

#include "viewer/panel/theme.hpp"

namespace linescope {
namespace {

constexpr double kScaleEnd = 30;  ///< mm

}  // namespace

GapGauge::GapGauge(QWidget* parent) : QWidget(parent) {
  setFixedHeight(scaled(58));
  setToolTip("Gap: distance from the endoscope to the surface; good between 10 and 20 mm");
}

void GapGauge::show_gap(const Readout& readout, double gap_mm) {
  readout_ = readout;
  gap_ = gap_mm;
  update();
}

void GapGauge::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const double left = scaled(8), width = this->width() - 2.0 * left, top = scaled(26), height = scaled(10);
  const auto x = [&](double mm) { return left + width * std::clamp(mm, 0.0, kScaleEnd) / kScaleEnd; };
  const bool good = gap_ >= kGapFrom && gap_ <= kGapTo;
  painter.setPen(colour(palette::kQuiet).lighter(120));
  painter.drawText(QRectF(left, 0, width, top), Qt::AlignLeft | Qt::AlignVCenter, "Gap");
  painter.setPen(readout_.blank() ? colour(palette::kQuiet) : colour(good ? Mood::good : Mood::caution));
  const QString text = readout_.blank() ? QString("– –  %1").arg(QString::fromStdString(readout_.reason))
                                        : QString("%1 %2").arg(QString::fromStdString(readout_.text),
                                                               good              ? ""
                                                               : gap_ < kGapFrom ? "· too near"
                                                                                 : "· too far");
  painter.drawText(QRectF(left, 0, width, top), Qt::AlignRight | Qt::AlignVCenter, text);
  painter.setPen(Qt::NoPen);
  painter.setBrush(colour(palette::of(0x28323b)));
  painter.drawRoundedRect(QRectF(left, top, width, height), 3, 3);
  painter.setBrush(colour(palette::of(0x1c6b57)));
  painter.drawRect(QRectF(x(kGapFrom), top, x(kGapTo) - x(kGapFrom), height));
  painter.setPen(colour(palette::kQuiet));
  for (const double mm : {0.0, 10.0, 20.0, 30.0}) {
    const double wide = scaled(40);
    const Qt::Alignment side = mm == 0 ? Qt::AlignLeft : mm == kScaleEnd ? Qt::AlignRight : Qt::AlignHCenter;
    const double from = mm == 0 ? left : mm == kScaleEnd ? left + width - wide : x(mm) - wide / 2;
    painter.drawText(QRectF(from, top + height, wide, scaled(20)), side | Qt::AlignVCenter,
                     QString::number(mm));
  }
  if (readout_.blank()) return;
  painter.setPen(Qt::NoPen);
  painter.setBrush(Qt::white);
  painter.drawRect(QRectF(x(gap_) - scaled(1.5), top - scaled(4), scaled(3), height + scaled(8)));
}

}  // namespace linescope
