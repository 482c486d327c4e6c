// Recorded poses looked up by picture: a robot, or a tracker read once per picture.
//
//   frame,x_mm,y_mm,z_mm,qw,qx,qy,qz[,station]
//   im0.png,116.7,474.4,235.6,-0.362,0.616,-0.601,-0.356
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "acquire/tracker/tracker_ledger.hpp"

namespace linescope {

/// A picture and the instant its pose belongs to: the middle of its exposure on the tracker's clock, that is
/// with the camera latency already taken off.
struct PictureInstant {
  std::string name;  ///< file name; a folder in front of it is ignored on both sides
  Nanoseconds time = 0;
};

struct PicturePoseOptions {
  int station = 0;  ///< whose poses these are, where the file has no `station` column (which counts from 1)
};

/// Stepped. For each picture in time order: the samples of its rows, or one sample in state `missing` when
/// the file has no row for it (counted as missing_poses). A row that cannot be used (NaN, zero quaternion,
/// too few fields) is reported once, when its picture's turn has come, and that picture then counts as
/// missing. The order of the rows does not matter; two rows for the same picture and station make start()
/// fail, as does a missing column.
class PicturePoseSource : public TrackerSource {
 public:
  PicturePoseSource(std::filesystem::path file, std::vector<PictureInstant> pictures,
                    const PicturePoseOptions& options);

  Result<void> start() override;
  Result<Pull> next(PoseSample& out) override;
  bool live() const override { return false; }
  std::string description() const override;
  TrackerStatus status() const override { return ledger_.status(); }
  StationStatus station(int station) const override { return ledger_.station(station); }
  TrackerCounters counters() const override { return ledger_.counters(); }

 private:
  struct Row {
    std::uint8_t station = 0;
    std::size_t line = 0;
    Result<Rigid<World, Sensor>> pose;
  };

  Result<void> read_rows();
  Result<void> read_row(const class CsvReader& reader, std::size_t frame_column,
                        const class PoseColumns& columns);
  void plan_picture(const PictureInstant& picture, std::uint32_t number);
  void describe();

  std::filesystem::path file_;
  std::vector<PictureInstant> pictures_;
  PicturePoseOptions options_;
  std::map<std::string, std::vector<Row>> rows_;
  std::vector<Result<PoseSample>> plan_;  ///< everything next() will say, in order
  std::size_t position_ = 0;
  TrackerLedger ledger_;
};

}  // namespace linescope
