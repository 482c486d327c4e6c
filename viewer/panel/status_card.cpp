#include "viewer/panel/status_card.hpp"

#include <QHBoxLayout>
#include <QLabel>
#include <QPainter>
#include <QVBoxLayout>

#include "viewer/panel/theme.hpp"

namespace linescope {

ElidedLabel::ElidedLabel(QWidget* parent) : QFrame(parent), colour_(colour(palette::kText)) {
  setStyleSheet("background: transparent; border: none;");
  setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);
  set_size(scaled(13));
}

void ElidedLabel::set_size(int pixels, bool bold) {
  QFont f = font();
  f.setPixelSize(pixels);
  f.setBold(bold);
  setFont(f);
  // A style sheet of its own font size would win over setFont.
  setStyleSheet(QString("background: transparent; border: none; font-size: %1px; font-weight: %2;")
                    .arg(pixels)
                    .arg(bold ? "bold" : "normal"));
  updateGeometry();
}

void ElidedLabel::set_text(const QString& text) {
  if (text == text_) return;
  text_ = text;
  setToolTip(text);
  update();
}

void ElidedLabel::set_colour(const QColor& wanted) {
  if (wanted == colour_) return;
  colour_ = wanted;
  update();
}

QSize ElidedLabel::sizeHint() const {
  return {fontMetrics().horizontalAdvance(text_), fontMetrics().height()};
}

QSize ElidedLabel::minimumSizeHint() const {
  return {0, fontMetrics().height()};
}

void ElidedLabel::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setFont(font());
  painter.setPen(colour_);
  painter.drawText(rect(), Qt::AlignLeft | Qt::AlignVCenter,
                   fontMetrics().elidedText(text_, Qt::ElideRight, width()));
}

StatusCard::StatusCard(QWidget* parent)
    : QFrame(parent),
      title_(new ElidedLabel(this)),
      word_(new ElidedLabel(this)),
      detail_(new ElidedLabel(this)) {
  setObjectName("card");
  auto* rows = new QVBoxLayout(this);
  rows->setContentsMargins(scaled(10), scaled(5), scaled(10), scaled(5));
  rows->setSpacing(scaled(1));
  auto* first = new QHBoxLayout;
  first->setSpacing(scaled(8));
  first->addWidget(title_, 1);
  first->addWidget(word_, 1);
  rows->addLayout(first);
  rows->addWidget(detail_);
  title_->set_size(scaled(13), true);
  detail_->set_size(scaled(12));
  detail_->set_colour(colour(palette::kQuiet).lighter(120));
}

void StatusCard::show_status(const StatusLine& status) {
  title_->set_text(QString::fromStdString(status.title));
  word_->set_text(mark(status.mood) + " " + QString::fromStdString(status.word));
  word_->set_colour(colour(status.mood));
  detail_->set_text(QString::fromStdString(status.detail));
}

}  // namespace linescope
