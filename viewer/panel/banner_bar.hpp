// One line under the buttons: the most important thing that is wrong and what to do, or how the scan stands.
#pragma once

#include <QFrame>

#include "viewer/readouts.hpp"

class QLabel;

namespace linescope {

class ElidedLabel;

class BannerBar : public QFrame {
 public:
  explicit BannerBar(QWidget* parent);
  /// `otherwise` is shown while nothing is wrong.
  void show_banner(const Banner& banner, const QString& otherwise);
  /// The daemon's answer or another event; shown for a few seconds when nothing is wrong.
  void show_notice(const Notice& notice);

  const QString& text() const;
  const QString& advice() const;
  const QString& notice() const { return notice_; }

 private:
  ElidedLabel* text_;
  ElidedLabel* advice_;
  QString notice_;
  Notice::Kind notice_kind_ = Notice::Kind::information;
  Nanoseconds notice_until_ = 0;
};

}  // namespace linescope
