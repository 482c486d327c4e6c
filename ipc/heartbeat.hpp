// The daemon's heartbeat: a thread of its own, so that it goes on when camera and tracker are silent.
#pragma once

#include <memory>

#include "ipc/segment_writer.hpp"

namespace linescope {

class Heartbeat {
 public:
  /// Beats every 20 ms until destroyed. `writer` must live longer.
  explicit Heartbeat(SegmentWriter& writer);
  ~Heartbeat();
  Heartbeat(const Heartbeat&) = delete;
  Heartbeat& operator=(const Heartbeat&) = delete;

  /// True when the segment was taken over by another daemon or removed by hand: end the program.
  bool lost() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace linescope
