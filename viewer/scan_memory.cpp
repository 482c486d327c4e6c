#include "viewer/scan_memory.hpp"

namespace linescope {

void ScanMemory::change_session() {
  carried_.insert(carried_.end(), present_.begin(), present_.end());
  present_.clear();
  scan_id_ = 0;
}

LineNews ScanMemory::forget(ScanView& scan) {
  carried_.clear();
  present_.clear();
  scan.lines_unplaced = 0;
  recount(scan);
  return {.forget = true, .lines = {}};
}

void ScanMemory::recount(ScanView& scan) const {
  scan.lines = carried_.size() + present_.size();
  scan.points = 0;
  for (const HeldLines* part : {&carried_, &present_})
    for (const auto& line : *part) scan.points += line->points.size();
}

void ScanMemory::begin_again(const LineBatch& batch, ScanView& scan, LineNews& news) {
  news.forget = true;
  present_.clear();
  // Another scan than before: cleared or new. The same: a sweep was taken back. The first of this daemon: a
  // sweep more.
  if (scan_id_ != 0 && batch.scan_id != scan_id_) carried_.clear();
  news.lines = carried_;
  scan.newest = {};
  scan.lines_unplaced = 0;
  recount(scan);
}

void ScanMemory::add(const Line& line, std::span<const SurfacePoint> points, ScanView& scan, LineNews& news) {
  auto placed = placer_.place(line, points);
  if (!placed) {
    ++scan.lines_unplaced;
    scan.unplaced_because = placed.error();
    return;
  }
  present_.push_back(*placed);
  news.lines.push_back(*placed);
  ++scan.lines;
  scan.points += points.size();
}

LineNews ScanMemory::take(const LineBatch& batch, ScanView& scan) {
  LineNews news;
  if (batch.restarted) begin_again(batch, scan, news);
  scan_id_ = batch.scan_id;
  scan.scan_id = batch.scan_id;
  scan.lines_missed += batch.missed;
  scan.lines_damaged += batch.damaged;
  for (const Line& line : batch.lines) add(line, batch.points_of(line), scan, news);
  if (!batch.lines.empty()) {
    const Line& last = batch.lines.back();
    scan.newest = {.time = last.time,
                   .points = static_cast<int>(last.point_count),
                   .coverage = last.quality.coverage,
                   .snr = last.quality.mean_snr,
                   .deviation = last.quality.mean_deviation,
                   .gap = placer_.gap(last, batch.points_of(last))};
  }
  return news;
}

}  // namespace linescope
