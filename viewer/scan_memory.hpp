// What the viewer remembers of the scan, so that a surface outlives the daemon that measured it.
//
// A restarted daemon knows nothing of the former scan, but the object's frame is still fixed to the object:
// the former lines are carried over and the new ones are added. Clearing or beginning a new scan forgets
// both; undoing a sweep forgets the lines of the present daemon that it takes back. Belongs to the
// acquisition thread.
#pragma once

#include "ipc/line_batch.hpp"
#include "viewer/line_placer.hpp"
#include "viewer/view_state.hpp"

namespace linescope {

class ScanMemory {
 public:
  explicit ScanMemory(LinePlacer placer) : placer_(std::move(placer)) {}

  LinePlacer& placer() { return placer_; }

  /// Another daemon answers from now on: what it sends is added to what is there.
  void change_session();

  /// Takes a batch in; the result says what everybody else has to do. Counts into `scan`.
  LineNews take(const LineBatch& batch, ScanView& scan);

  /// Forgets everything, whatever the daemon still holds.
  LineNews forget(ScanView& scan);

 private:
  void begin_again(const LineBatch& batch, ScanView& scan, LineNews& news);
  void add(const Line& line, std::span<const SurfacePoint> points, ScanView& scan, LineNews& news);
  void recount(ScanView& scan) const;

  LinePlacer placer_;
  HeldLines carried_, present_;
  std::uint32_t scan_id_ = 0;  ///< of the present daemon; 0: none yet
};

}  // namespace linescope
