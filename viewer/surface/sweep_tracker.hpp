// When a new sweep begins: on request, after a pause, after the last one was taken back.
#pragma once

#include "common/time.hpp"

namespace linescope {

class SweepTracker {
 public:
  explicit SweepTracker(Nanoseconds pause) : pause_(pause) {}

  void request() { wanted_ = true; }

  /// To be asked once for every line taken in.
  bool begins_with(Nanoseconds line_time) {
    const bool begins = wanted_ || line_time - last_ > pause_;
    wanted_ = false;
    last_ = line_time;
    return begins;
  }

 private:
  Nanoseconds pause_;
  Nanoseconds last_ = 0;
  bool wanted_ = true;
};

}  // namespace linescope
