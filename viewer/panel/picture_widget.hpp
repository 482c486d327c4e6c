// The endoscope's picture with the extracted laser line drawn into it.
#pragma once

#include <QWidget>
#include <memory>

#include "viewer/view_state.hpp"

namespace linescope {

class PictureWidget : public QWidget {
 public:
  explicit PictureWidget(QWidget* parent = nullptr);

  /// `why_old`: when not empty the picture is dimmed and this is written over it.
  void show_picture(std::shared_ptr<const CameraPicture> picture, const QString& why_old);

  bool has_picture() const { return picture_ != nullptr; }

 protected:
  void paintEvent(QPaintEvent* event) override;
  int heightForWidth(int width) const override;
  bool hasHeightForWidth() const override { return true; }

 private:
  void paint_line(QPainter& painter, const QRectF& into) const;

  std::shared_ptr<const CameraPicture> picture_;
  QString why_old_;
};

}  // namespace linescope
