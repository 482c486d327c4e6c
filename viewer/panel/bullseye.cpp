#include "viewer/panel/bullseye.hpp"

#include <QPainter>
#include <algorithm>
#include <cmath>

#include "viewer/panel/theme.hpp"

namespace linescope {
namespace {

constexpr double kOuter = 20;  ///< degrees at the outer ring

QString signed_degrees(double value) {
  return QString("%1%2°").arg(value < 0 ? "−" : "+").arg(std::abs(value), 0, 'f', 1);
}

}  // namespace

Bullseye::Bullseye(QWidget* parent) : QWidget(parent) {
  setMinimumHeight(scaled(120));
  setToolTip("Bullseye along the harvester: bring the dot into the ring. Rings: 5, 10, 15, 20 degrees");
}

void Bullseye::show_reading(const std::optional<BullseyeReading>& reading) {
  reading_ = reading;
  update();
}

void Bullseye::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const double text = scaled(22);
  const double radius = std::min(width() / 2.0, (height() - text) / 2.0) - scaled(6);
  const QPointF centre(width() / 2.0, (height() - text) / 2.0);
  const auto ring = [&](double degrees) {
    painter.drawEllipse(centre, radius * degrees / kOuter, radius * degrees / kOuter);
  };
  painter.setPen(QPen(colour(palette::of(0x3a4650)), 1));
  for (const double degrees : {5.0, 10.0, 15.0, 20.0}) ring(degrees);
  painter.drawLine(centre - QPointF(radius, 0), centre + QPointF(radius, 0));
  painter.drawLine(centre - QPointF(0, radius), centre + QPointF(0, radius));
  const double tolerance = reading_ ? reading_->tolerance_deg : 3;
  painter.setPen(QPen(colour(Mood::good), scaled(2)));
  ring(tolerance);
  const QRectF foot(0, height() - text, width(), text);
  if (!reading_) {
    painter.setPen(colour(palette::kQuiet));
    painter.drawText(foot, Qt::AlignCenter, "right – –    up – –");
    return;
  }
  double x = reading_->right_deg, y = reading_->up_deg;
  const double size = std::hypot(x, y);
  if (size > kOuter) x *= kOuter / size, y *= kOuter / size;
  const QPointF dot = centre + QPointF(x, -y) * (radius / kOuter);
  const bool good = size <= tolerance;
  painter.setPen(QPen(colour(palette::kHarvester), scaled(2)));
  painter.drawLine(centre, dot);
  painter.setPen(QPen(Qt::white, scaled(2)));
  painter.setBrush(good            ? colour(Mood::good)
                   : size > kOuter ? colour(Mood::bad)
                                   : colour(palette::kHarvester));
  painter.drawEllipse(dot, scaled(7), scaled(7));
  painter.setPen(colour(palette::kText));
  painter.drawText(foot, Qt::AlignCenter,
                   QString("right %1    up %2")
                       .arg(signed_degrees(reading_->right_deg), signed_degrees(reading_->up_deg)));
}

}  // namespace linescope
