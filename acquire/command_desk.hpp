// What viewers may ask of the daemon, and its answers. Belongs to the line's thread.
#pragma once

#include <atomic>
#include <string>

#include "acquire/laser_watch.hpp"
#include "acquire/record/recorder.hpp"
#include "acquire/scan_control.hpp"
#include "acquire/scan_saver.hpp"
#include "ipc/control.hpp"

namespace linescope {

class CommandDesk {
 public:
  /// `stop` is set by the command shut down. All references must outlive the desk.
  CommandDesk(SegmentWriter& writer, ScanControl& scan, LaserWatch& laser, std::atomic<bool>& stop);

  /// Every command becomes an event of the recording; null: none.
  void record_to(Recorder* recorder) { recorder_ = recorder; }

  /// Carries out whatever is waiting; never waits itself.
  void attend(Nanoseconds now);

 private:
  CommandAnswer carry_out(const ReceivedCommand& command, Nanoseconds now);
  CommandAnswer save(const ReceivedCommand& command);
  CommandAnswer expose(double milliseconds);
  void finish_save();

  ScanControl& scan_;
  LaserWatch& laser_;
  std::atomic<bool>& stop_;
  ControlServer server_;
  ScanSaver saver_;
  CommandId saving_ = 0;
  Recorder* recorder_ = nullptr;
};

}  // namespace linescope
