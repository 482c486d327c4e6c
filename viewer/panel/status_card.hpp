// One tool, camera or daemon at the foot of the window: name, state in a word with its mark, reason and age.
#pragma once

#include <QFrame>

#include "viewer/readouts.hpp"

class QLabel;

namespace linescope {

/// A label of one line that ends in "…" when there is no room and then tells the rest as its tooltip.
class ElidedLabel : public QFrame {
 public:
  explicit ElidedLabel(QWidget* parent = nullptr);
  void set_text(const QString& text);
  void set_colour(const QColor& colour);
  void set_size(int pixels, bool bold = false);
  const QString& text() const { return text_; }

 protected:
  void paintEvent(QPaintEvent* event) override;
  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

 private:
  QString text_;
  QColor colour_;
};

class StatusCard : public QFrame {
 public:
  explicit StatusCard(QWidget* parent = nullptr);
  void show_status(const StatusLine& status);

 private:
  ElidedLabel* title_;
  ElidedLabel* word_;
  ElidedLabel* detail_;
};

}  // namespace linescope
