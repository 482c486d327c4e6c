// AngDif in numerals that can be read from two metres, or "--" with the reason.
#pragma once

#include <QElapsedTimer>
#include <QFrame>

#include "viewer/readouts.hpp"

namespace linescope {

class AngleDisplay : public QFrame {
 public:
  explicit AngleDisplay(QWidget* parent = nullptr);

  void show_angle(const AngleReadout& readout);
  /// Height of the numerals, pixels at scale 1.
  void set_numeral_size(double pixels);

  const QString& shown() const { return shown_; }
  const QString& reason() const { return reason_; }
  /// Of the poses the digits on the screen rest on.
  Nanoseconds pose_time() const { return pose_time_; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  int fitting_size(QFont font, int width) const;

  QString shown_, reason_, interval_;
  Nanoseconds pose_time_ = 0;
  bool in_tolerance_ = false;
  double numeral_size_ = 60;
  QElapsedTimer changed_;
};

}  // namespace linescope
