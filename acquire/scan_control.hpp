// Starting, stopping, clearing and undoing a scan. Belongs to the line's thread.
#pragma once

#include <cstdint>
#include <vector>

#include "ipc/segment_writer.hpp"

namespace linescope {

/// A scan consists of sweeps: from one start to the next stop.
class ScanControl {
 public:
  explicit ScanControl(SegmentWriter& writer);

  void start(Nanoseconds now);
  void stop();
  /// Throws the scan away; scanning goes on if it was on.
  void clear(Nanoseconds now);
  /// Begins the next scan; the former stays only with those who copied it.
  void new_scan(Nanoseconds now);
  /// Takes the last sweep that holds lines back. False: there is none.
  bool undo_sweep();

  bool scanning() const { return writer_.scanning(); }

 private:
  void begin(Nanoseconds now, ScanCause cause);

  SegmentWriter& writer_;
  bool begun_ = false;
  std::vector<std::uint32_t> sweep_starts_;  ///< number of lines in the scan when each sweep began
};

}  // namespace linescope
