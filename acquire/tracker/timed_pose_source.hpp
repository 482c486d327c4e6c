// Recorded poses with their own time. Two forms, told apart by the header:
//
//   time_s,station,x_mm,y_mm,z_mm,qw,qx,qy,qz[,state][,frame_count][,distortion][,arrival_s]   one sensor per
//   row Time,w1,x1,y1,z1,w2,x2,y2,z2,loc1_x,loc1_y,loc1_z,loc2_x,loc2_y,loc2_z                       two
//   sensors per row
//
// The second is what a ROS recorder of a LIBERTY wrote: every row repeats the sensor that did not change. A
// sensor gives a sample only where its seven numbers change; its frame count is the running number of those
// changes.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "acquire/tracker/tracker_ledger.hpp"

namespace linescope {

class TimedRows;

struct TimedPoseOptions {
  std::optional<Nanoseconds>
      first_row_at;  ///< moves all times so that the first row lies here; nothing: as in the file
  double mm_per_unit =
      10;  ///< positions of the two-sensor form carry no unit; a LIBERTY set to centimetres: 10
};

/// Stepped; rows are read one by one, a recording of any length is fine.
/// A row that cannot be used (NaN, zero quaternion, too few fields, unknown state) is reported with code
/// `unreadable` and left out; the next call goes on behind it. A row older than the one before, or as old as
/// the same station's last one, is reported with code `invalid` and ends the source: the order of what
/// follows cannot be trusted.
class TimedPoseSource : public TrackerSource {
 public:
  TimedPoseSource(std::filesystem::path file, const TimedPoseOptions& options);
  ~TimedPoseSource() override;

  Result<void> start() override;
  Result<Pull> next(PoseSample& out) override;
  bool live() const override { return false; }
  std::string description() const override;
  TrackerStatus status() const override { return ledger_.status(); }
  StationStatus station(int station) const override { return ledger_.station(station); }
  TrackerCounters counters() const override { return ledger_.counters(); }

 private:
  Result<bool> read_row();
  Result<void> check_order(const std::vector<PoseSample>& samples);

  std::filesystem::path file_;
  TimedPoseOptions options_;
  std::unique_ptr<TimedRows> rows_;
  std::vector<PoseSample> pending_;  ///< samples of the current row, at most two
  std::size_t handed_out_ = 0;
  std::optional<Nanoseconds> shift_;
  std::optional<Nanoseconds> last_row_;
  std::vector<std::optional<Nanoseconds>> last_of_station_;
  bool ended_ = false;
  TrackerLedger ledger_;
};

}  // namespace linescope
