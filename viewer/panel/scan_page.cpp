#include "viewer/panel/scan_page.hpp"

#include <fmt/format.h>

#include "viewer/panel/gap_gauge.hpp"
#include "viewer/panel/picture_widget.hpp"

namespace linescope {
namespace {

std::string why_picture_is_old(const LiveView& live, Nanoseconds now) {
  if (live.link.state != LinkState::attached) return "no daemon";
  if (!live.picture) return "no picture yet";
  if (now - live.picture->time <= kPictureIsLiveFor) return {};
  const StatusLine camera = camera_status(live, now);
  return fmt::format("last picture {} ago\ncamera {}", age_text(live.picture->time, now), camera.word);
}

std::string left_out(const ScanView& scan) {
  if (scan.lines_unplaced + scan.lines_missed + scan.lines_damaged == 0) return "nothing";
  std::string text;
  if (scan.lines_unplaced > 0)
    text += fmt::format("{} lines (object {}) ", grouped(scan.lines_unplaced), name(scan.unplaced_because));
  if (scan.lines_missed > 0) text += fmt::format("{} lines missed ", grouped(scan.lines_missed));
  if (scan.lines_damaged > 0) text += fmt::format("{} damaged", grouped(scan.lines_damaged));
  return text;
}

}  // namespace

ScanPage::ScanPage(QWidget* parent)
    : SidePage(parent), picture_(new PictureWidget(this)), gap_(new GapGauge(this)) {
  column_->addWidget(picture_, 1);
  column_->addWidget(gap_);
  add_heading("Newest line");
  line_ = add_row("Quality");
  deviation_ = add_row("Deviation");
  add_heading("Scan");
  gathered_ = add_row("Gathered");
  area_ = add_row("Coverage");
  left_out_ = add_row("Not drawn");
}

void ScanPage::show_state(const ViewState& state, Nanoseconds now) {
  const LiveView& live = *state.live;
  picture_->show_picture(live.picture, QString::fromStdString(why_picture_is_old(live, now)));
  gap_->show_gap(gap_readout(live, now), live.scan.newest.gap);
  const Readout quality = line_quality_readout(live, now);
  line_->set_text(text_of(quality));
  deviation_->set_text(
      quality.blank() ? text_of(quality)
                      : QString("%1 mm").arg(static_cast<double>(live.scan.newest.deviation), 0, 'f', 2));
  gathered_->set_text(QString::fromStdString(
      fmt::format("{} points, {} lines", grouped(live.scan.points), grouped(live.scan.lines))));
  const SurfaceView& surface = *state.surface;
  area_->set_text(surface.mesh && !surface.mesh->empty()
                      ? QString("about %1 mm²").arg(surface.seen_area, 0, 'f', 0)
                      : QStringLiteral("– –  no surface yet"));
  left_out_->set_text(QString::fromStdString(left_out(live.scan)));
  left_out_->set_colour(live.scan.lines_unplaced > 0 ? colour(Mood::caution) : colour(palette::kText));
}

}  // namespace linescope
