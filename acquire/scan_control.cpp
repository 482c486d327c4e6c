#include "acquire/scan_control.hpp"

namespace linescope {

ScanControl::ScanControl(SegmentWriter& writer) : writer_(writer) {
  sweep_starts_.reserve(1024);
}

void ScanControl::begin(Nanoseconds now, ScanCause cause) {
  writer_.begin_scan(now, cause);
  begun_ = true;
  sweep_starts_.assign(1, 0);
}

void ScanControl::start(Nanoseconds now) {
  if (writer_.scanning()) return;
  if (!begun_) begin(now, ScanCause::new_scan);
  if (sweep_starts_.empty() || sweep_starts_.back() != writer_.lines_in_scan())
    sweep_starts_.push_back(writer_.lines_in_scan());
  writer_.set_scanning(true);
}

void ScanControl::stop() {
  writer_.set_scanning(false);
}

void ScanControl::clear(Nanoseconds now) {
  begin(now, ScanCause::cleared);
}

void ScanControl::new_scan(Nanoseconds now) {
  begin(now, ScanCause::new_scan);
}

bool ScanControl::undo_sweep() {
  while (!sweep_starts_.empty() && sweep_starts_.back() >= writer_.lines_in_scan()) sweep_starts_.pop_back();
  if (sweep_starts_.empty() || writer_.lines_in_scan() == 0) return false;
  writer_.undo_to(sweep_starts_.back());
  return true;
}

}  // namespace linescope
