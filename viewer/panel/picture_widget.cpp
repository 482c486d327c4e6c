#include "viewer/panel/picture_widget.hpp"

#include <QImage>
#include <QPainter>

#include "viewer/panel/theme.hpp"

namespace linescope {
namespace {

/// No copy: the picture outlives the image, which is only drawn.
QImage image_of(const CameraPicture& p) {
  const auto format = p.channels == 1 ? QImage::Format_Grayscale8 : QImage::Format_BGR888;
  return {p.pixels.data(), p.width, p.height, p.width * p.channels, format};
}

}  // namespace

PictureWidget::PictureWidget(QWidget* parent) : QWidget(parent) {
  QSizePolicy policy(QSizePolicy::Expanding, QSizePolicy::Preferred);
  policy.setHeightForWidth(true);
  setSizePolicy(policy);
  setMinimumHeight(scaled(140));
  setToolTip("Endoscope picture; yellow: the laser line as extracted");
}

int PictureWidget::heightForWidth(int width) const {
  return width * 3 / 4;
}

void PictureWidget::show_picture(std::shared_ptr<const CameraPicture> picture, const QString& why_old) {
  if (picture == picture_ && why_old == why_old_) return;
  picture_ = std::move(picture);
  why_old_ = why_old;
  update();
}

void PictureWidget::paint_line(QPainter& painter, const QRectF& into) const {
  const double sx = into.width() / picture_->width, sy = into.height() / picture_->height;
  QVector<QPointF> points;
  points.reserve(static_cast<int>(picture_->line.size()));
  // Pixel centres are whole numbers: the first pixel reaches from -0.5 to 0.5.
  for (const Eigen::Vector2f& p : picture_->line)
    points.append({into.x() + (static_cast<double>(p.x()) + 0.5) * sx,
                   into.y() + (static_cast<double>(p.y()) + 0.5) * sy});
  painter.setPen(QPen(colour(palette::kNewLine), 1.5));
  painter.drawPoints(points.data(), points.size());
}

void PictureWidget::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), colour(palette::of(0x0a0d10)));
  if (picture_ && picture_->width > 0 && picture_->height > 0) {
    const QSizeF size =
        QSizeF(picture_->width, picture_->height).scaled(QSizeF(rect().size()), Qt::KeepAspectRatio);
    const QRectF into(QPointF((width() - size.width()) / 2, (height() - size.height()) / 2), size);
    painter.setOpacity(why_old_.isEmpty() ? 1.0 : 0.25);
    painter.drawImage(into, image_of(*picture_));
    if (why_old_.isEmpty()) paint_line(painter, into);
  }
  painter.setOpacity(1.0);
  if (!why_old_.isEmpty()) {
    painter.setPen(colour(Mood::caution));
    painter.drawText(rect().adjusted(8, 8, -8, -8), Qt::AlignCenter | Qt::TextWordWrap, why_old_);
  }
}

}  // namespace linescope
