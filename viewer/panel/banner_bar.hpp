// One line under the buttons: the most important thing that is wrong and what to do, or how the scan stands.
#pragma once

#include <QFrame>
#include <functional>
#include <optional>

#include "viewer/readouts.hpp"

class QProgressBar;
class QPushButton;

namespace linescope {

class ElidedLabel;

class BannerBar : public QFrame {
 public:
  BannerBar(const std::function<void()>& cancel, QWidget* parent);
  /// `otherwise` is shown while nothing is wrong.
  void show_banner(const Banner& banner, const QString& otherwise);
  /// The daemon's answer or another event; shown for a few seconds when nothing is wrong.
  void show_notice(const Notice& notice);
  /// Longer work: its name and how much of it is done, 0..1, with a button to give it up; nothing: none.
  void show_job(const std::optional<std::pair<QString, double>>& job);

  const QString& text() const;
  const QString& advice() const;
  const QString& notice() const { return notice_; }

 private:
  ElidedLabel* text_;
  ElidedLabel* advice_;
  QProgressBar* progress_;
  QPushButton* cancel_;
  QString notice_;
  Notice::Kind notice_kind_ = Notice::Kind::information;
  Nanoseconds notice_until_ = 0;
};

}  // namespace linescope
