// Distance from the endoscope to the surface, with the range in which the line can be measured well.
#pragma once

#include <QWidget>

#include "viewer/readouts.hpp"

namespace linescope {

class GapGauge : public QWidget {
 public:
  explicit GapGauge(QWidget* parent = nullptr);
  /// `gap_mm` is meaningless when the readout is blank.
  void show_gap(const Readout& readout, double gap_mm);

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  Readout readout_;
  double gap_ = 0;
};

}  // namespace linescope
