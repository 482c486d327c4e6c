#include "tools/calibrate/segment_input.hpp"

#include <fmt/format.h>

#include <array>
#include <deque>

#include "ipc/segment_reader.hpp"

namespace linescope::calibrate {
namespace {

constexpr Nanoseconds kWait = 20 * kMillisecond;
/// A daemon that was stopped or starved for a moment goes on; one that was killed does not.
constexpr Nanoseconds kPatience = 3 * kSecond;

Result<void> still_there(const SegmentReader& reader) {
  const LifeReport report = reader.report(monotonic_now());
  const bool may_come_back = report.life == Life::silent && report.silent_for < kPatience;
  if (report.life == Life::live || may_come_back) return {};
  return fail(ErrorCode::gone, report.text + ": nothing was calibrated");
}

class SegmentCamera final : public CameraSource {
 public:
  explicit SegmentCamera(SegmentReader reader) : reader_(std::move(reader)) {}

  Result<void> start() override { return {}; }
  bool live() const override { return true; }
  std::string description() const override { return "segment " + reader_.identity().name; }
  CameraStatus status() const override { return status_; }

  Result<Pull> next(Frame& frame) override {
    if (auto ok = still_there(reader_); !ok) return tl::unexpected(ok.error());
    reader_.wait(Topic::pictures, kWait);
    switch (reader_.picture(picture_)) {
      case ReadOutcome::ok:
        break;
      case ReadOutcome::corrupt:
        return fail(ErrorCode::gone, "the segment is damaged: restart the daemon");
      default:
        return Pull::nothing_yet;
    }
    hand_over(frame);
    status_.state = CameraState::ok;
    ++status_.counters.delivered;
    return Pull::item;
  }

 private:
  void hand_over(Frame& frame) {
    const bool colour = picture_.format == PixelFormat::bgr8;
    const cv::Mat seen(static_cast<int>(picture_.height), static_cast<int>(picture_.width),
                       colour ? CV_8UC3 : CV_8UC1, picture_.pixels.data(), picture_.stride);
    frame.bgr = seen.clone();
    frame.time = picture_.time;
    frame.index = picture_.frame;
    frame.name = picture_.name;
  }

  SegmentReader reader_;
  Picture picture_;
  CameraStatus status_;
};

class SegmentTracker final : public TrackerSource {
 public:
  explicit SegmentTracker(SegmentReader reader) : reader_(std::move(reader)) {}

  Result<void> start() override { return {}; }
  bool live() const override { return true; }
  std::string description() const override { return "segment " + reader_.identity().name; }
  TrackerStatus status() const override { return {}; }
  StationStatus station(int) const override { return {}; }
  TrackerCounters counters() const override { return counters_; }

  Result<Pull> next(PoseSample& out) override {
    if (waiting_.empty()) fetch();
    if (waiting_.empty())
      if (auto ok = still_there(reader_); !ok) return tl::unexpected(ok.error());
    if (waiting_.empty()) return Pull::nothing_yet;
    out = waiting_.front();
    waiting_.pop_front();
    ++counters_.samples;
    return Pull::item;
  }

 private:
  void fetch() {
    for (int station = 0; station < kMaxStations; ++station) {
      std::uint64_t missed = 0;
      batch_.clear();
      reader_.new_poses(station, cursors_[static_cast<std::size_t>(station)], batch_, missed);
      counters_.lost += missed;
      waiting_.insert(waiting_.end(), batch_.begin(), batch_.end());
    }
  }

  SegmentReader reader_;
  std::array<PoseCursor, kMaxStations> cursors_;
  std::vector<PoseSample> batch_;
  std::deque<PoseSample> waiting_;
  TrackerCounters counters_;
};

Stations stations_of(const SegmentReader& reader) {
  Stations stations{-1, -1, -1};
  for (int i = 0; i < kMaxStations; ++i) {
    SensorStatus status;
    if (reader.sensor_status(i, status) != ReadOutcome::ok) continue;
    if (status.role == SensorRole::endoscope) stations.endoscope = i;
    if (status.role == SensorRole::object) stations.object = i;
    if (status.role == SensorRole::harvester) stations.harvester = i;
  }
  return stations;
}

}  // namespace

Result<Input> input_from_segment(const std::string& name) {
  AttachOptions attach;
  attach.name = name;
  auto pictures = SegmentReader::attach(attach);
  if (!pictures) return tl::unexpected(pictures.error());
  auto poses = SegmentReader::attach(attach);
  if (!poses) return tl::unexpected(poses.error());
  Input input;
  input.stations = stations_of(*pictures);
  std::string yaml;
  if (pictures->calibration(yaml) == ReadOutcome::ok) {
    auto calibration = calibration_from_text(yaml, "of the segment");
    if (calibration) input.calibration = *calibration;
  }
  input.description = fmt::format("segment {}", name);
  input.camera = std::make_unique<SegmentCamera>(std::move(*pictures));
  input.tracker = std::make_unique<SegmentTracker>(std::move(*poses));
  return input;
}

}  // namespace linescope::calibrate
