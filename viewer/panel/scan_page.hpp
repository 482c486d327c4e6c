// The moment "Scan": picture, gap, quality of the line, what was gathered.
#pragma once

#include "viewer/panel/side_page.hpp"

namespace linescope {

class PictureWidget;
class GapGauge;

class ScanPage : public SidePage {
 public:
  explicit ScanPage(QWidget* parent);
  void show_state(const ViewState& state, Nanoseconds now);

 private:
  PictureWidget* picture_;
  GapGauge* gap_;
  ElidedLabel *line_, *deviation_, *gathered_, *area_, *left_out_;
};

}  // namespace linescope
